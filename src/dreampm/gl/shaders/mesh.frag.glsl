#include "frame.glsl"
#include "sun.glsl"
uniform sampler2DShadow sun_depth;
uniform sampler2D sun_darkness;
uniform vec4 color;   // linear, opacity
uniform float flat_faces;
in vec3 world, facing;
out vec4 fragment;
void main() {
  vec3 to_eye = normalize(eye.xyz - world);
  vec3 n = flat_faces > 0.5 ? cross(dFdx(world), dFdy(world)) : facing;
  n = normalize(n);
  if (dot(n, to_eye) < 0.0) n = -n;
  vec3 to_key = normalize(light_position[0].xyz - world), to_fill = normalize(light_position[1].xyz - world);
  vec3 at = sun_place(world + n * (2.0 * sun_height.w));
  float lit = texture(sun_depth, vec3(at.xy, at.z - 2.0 * sun_height.w * sun_height.y));
  lit = 1.0 - sun_height.z * texture(sun_darkness, at.xy).r * (1.0 - lit);
  vec3 light = ambient(n.y) + light_color[0].rgb * (lit * max(dot(n, to_key), 0.0)) +
               light_color[1].rgb * max(dot(n, to_fill), 0.0);
  float shine = pow(max(dot(n, normalize(to_key + to_eye)), 1e-3), 60.0);
  fragment = vec4(encode(color.rgb * light + 0.15 * lit * shine), color.a);
}
