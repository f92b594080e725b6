#include "frame.glsl"
#include "sun.glsl"
// Puts the liquid over the picture: reflection by Schlick's fit of Fresnel's formula, refraction of
// what lies behind, absorption by Beer and Lambert.
uniform sampler2D surface, field;  // water_normal.frag, water_filter.frag
uniform sampler2D behind, depth;   // what is drawn so far
uniform float far;
uniform vec3 absorption, tint;     // 1/m, linear
uniform float cloudiness, refractive_index, floor_shown;
in vec2 uv;
out vec4 fragment;

vec3 reflected(vec3 world, vec3 ray) {
  vec3 up = sky(ray);
  if (floor_shown < 0.5 || ray.y >= 0.0) return up;
  float t = (sun_height.x - world.y) / min(ray.y, -1e-3);
  vec3 light = ambient(1.0) + light_color[0].rgb * 0.7;
  return mix(0.6 * floor_bright.rgb * light, up, smoothstep(0.0, 4.0 * floor_shape.w, abs(t)));
}
void main() {
  vec4 s = texture(surface, uv);
  float cover = smoothstep(0.15, 0.75, s.a);
  if (cover <= 0.0) discard;
  s /= s.a;
  float z = far - s.b, opaque = eye_distance(texture(depth, uv).r);
  if (z > opaque) discard;
  vec3 p = eye_point(uv * viewport.xy, z);
  vec3 n = vec3(s.rg, sqrt(max(1.0 - dot(s.rg, s.rg), 0.0)));
  vec3 ray = normalize(p);
  float slant = length(p) / z;  // of the view, to its axis
  float facing = clamp(-dot(n, ray), 0.0, 1.0);
  float path = min(texture(field, uv).a, opaque - z) * slant;

  // Where the refracted ray leaves the liquid, and what is seen there.
  vec3 bent = refract(ray, n, 1.0 / refractive_index);
  vec3 leaves = p + bent * path;
  vec2 at = 0.5 + leaves.xy / -leaves.z * lens.x * viewport.zw;
  if (eye_distance(texture(depth, at).r) < z) at = uv;
  vec3 c = decode(texture(behind, at).rgb);
  c *= exp(-absorption * path);

  vec3 normal = to_world(n), world = eye.xyz + to_world(p);
  vec3 to_key = normalize(light_position[0].xyz - world), to_fill = normalize(light_position[1].xyz - world);
  vec3 inside = tint * (ambient(normal.y) + light_color[0].rgb * (0.35 + 0.65 * max(dot(normal, to_key), 0.0)) * 0.8 +
                        light_color[1].rgb * max(dot(normal, to_fill), 0.0));
  float cloud = 1.0 - exp(-cloudiness * path);
  c = mix(c, inside, cloud);

  float r0 = (refractive_index - 1.0) / (refractive_index + 1.0);
  r0 *= r0;
  float away = 1.0 - facing, away2 = away * away;
  float fresnel = r0 + (1.0 - r0) * away2 * away2 * away;
  vec3 view_ray = to_world(ray), mirror = reflect(view_ray, normal);
  c = mix(c, reflected(world, mirror), min(fresnel, 0.75));
  float shine = pow(max(dot(mirror, to_key), 1e-3), 220.0);
  c += light_color[0].rgb * shine * 1.6;
  fragment = vec4(encode(c), cover);
}
