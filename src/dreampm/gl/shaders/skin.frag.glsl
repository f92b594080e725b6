#include "frame.glsl"
#include "sun.glsl"
// Puts opaque matter with a smooth surface into the picture and its depth.
uniform sampler2D surface, field;  // surface_normal.frag, surface_filter.frag
uniform sampler2D colors;          // surface_color.frag
uniform sampler2DShadow sun_depth;
uniform sampler2D sun_darkness;
uniform float far, softness;       // softness [m]: shadows of the matter itself begin there
uniform vec3 base_color;           // sRGB
uniform float opacity, colored;    // colored 1: by particle
in vec2 uv;
out vec4 fragment;

void main() {
  vec4 s = texture(surface, uv);
  // The outermost texels, where the surface turns away, are rough: the outline lies within them.
  float cover = min(smoothstep(0.48, 0.62, texture(field, uv).g), smoothstep(0.1, 0.9, s.a));
  if (cover <= 0.0) discard;
  s /= s.a;
  vec2 n_xy = s.rg;
  float z = far - s.b;
  vec3 n = vec3(n_xy, sqrt(max(1.0 - dot(n_xy, n_xy), 0.0)));
  vec3 p = eye_point(uv * viewport.xy, z), world = eye.xyz + to_world(p);
  vec4 mean = texture(colors, uv);
  vec3 matter = decode(mix(base_color, mean.rgb / max(mean.a, 1e-4), colored));
  vec3 at = sun_place(world + to_world(n) * softness);
  float lit = 1.0 - sun_height.z * texture(sun_darkness, at.xy).r *
                        (1.0 - texture(sun_depth, vec3(at.xy, at.z - softness * sun_height.y)));
  float key = dot(n, eye_key.xyz), fill = dot(n, eye_fill.xyz);
  vec3 light = ambient(dot(n, eye_up.xyz)) + light_color[0].rgb * (lit * max(key, 0.0)) +
               light_color[1].rgb * max(fill, 0.0);
  vec3 ray = normalize(p);
  float away = 1.0 - clamp(-dot(n, ray), 0.0, 1.0);
  float edge = away * away * away;
  float shine = max(dot(reflect(ray, n), eye_key.xyz), 1e-3);
  vec3 gloss = light_color[0].rgb * (lit * (0.25 * pow(shine, 40.0) + 0.06 * pow(shine, 6.0))) +
               0.12 * edge * sky_low.rgb;
  fragment = vec4(encode(matter * light + gloss), cover * opacity);
  gl_FragDepth = (lens.z - lens.y * lens.z / z) / (lens.z - lens.y);
}
