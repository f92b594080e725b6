#include "surface.glsl"
// Puts the liquid over the picture: reflection by Schlick's fit of Fresnel's formula, refraction of
// what lies behind, absorption by Beer and Lambert. All directions are in the eye's space.
uniform sampler2D surface, field;  // surface_normal.frag, surface_filter.frag
uniform sampler2D behind, depth;   // what is drawn so far
in vec2 uv, slope;
flat in vec4 depths, extinction, matter, to_key, to_fill, up;
flat in vec3 key_light, fill_light, sky_near, sky_far, light_middle, light_slope, ground;
flat in vec2 pixels;
out vec4 fragment;

float opaque_at(vec2 at) { return depths.x / (depths.y - texture(depth, at).r * depths.z); }
float fourth(float x) { return x * x * x * x; }

void main() {
  vec4 f = texture(field, uv), s = texture(surface, uv);
  float cover = smoothstep(0.38, 0.6, f.g);
  if (cover <= 0.0 || s.a <= 0.0) discard;
  vec2 n_xy = mean_normal(surface, uv);
  s /= s.a;
  float z = depths.w - s.b, opaque = opaque_at(uv);
  if (z > opaque) discard;
  vec3 n = vec3(n_xy, sqrt(max(1.0 - dot(n_xy, n_xy), 0.0))), p = vec3(slope, -1.0) * z;
  float slant = length(vec3(slope, 1.0));  // of the view, to its axis
  vec3 ray = vec3(slope, -1.0) / slant;
  float facing = clamp(-dot(n, ray), 0.0, 1.0);

  // Where the refracted ray leaves the liquid, at the latest on the floor, and what is seen there.
  vec3 bent = refract(ray, n, 1.0 / matter.a);
  float path = f.a * slant, height_here = max(up.w + dot(p, up.xyz), 0.0), fall = -dot(bent, up.xyz);
  path = min(path, height_here / max(fall, 1e-3));
  // What stands in the liquid ends the ray before. How far off it is shows at the place where the
  // ray would come out, which depends on that: from what is straight behind it is found in two steps.
  float seen = opaque, ahead = max(-bent.z, 0.2);
  vec2 at = uv;
  for (int k = 0; k < 2; ++k) {
    vec3 leaves = p + bent * min(path, (seen - z) / ahead);
    vec2 there = 0.5 + leaves.xy / -leaves.z * pixels;
    float found = opaque_at(there);
    if (found < z) break;  // something before the liquid
    at = there;
    seen = found;
  }
  path = min(path, (seen - z) / ahead);
  vec3 c = texture(behind, at).rgb;
  c *= c * exp(-extinction.rgb * path);

  // What clouds it sends back the light that falls on it.
  float rise = dot(n, up.xyz);
  vec3 inside = matter.rgb * (light_middle + light_slope * rise +
                              key_light * (0.4 + 0.6 * max(dot(n, to_key.xyz), 0.0)) +
                              fill_light * max(dot(n, to_fill.xyz), 0.0));
  c = mix(inside, c, exp(-extinction.a * path));

  float away = 1.0 - facing;
  float fresnel = to_key.a + (1.0 - to_key.a) * fourth(away) * away;
  vec3 mirror = reflect(ray, n);
  float height = dot(mirror, up.xyz);
  vec3 sky = mix(sky_near, sky_far, sqrt(clamp(height, 0.0, 1.0)));
  sky = mix(sky, ground, smoothstep(0.0, 0.25, -height));
  c = mix(c, sky, min(1.4 * fresnel, 0.75));
  // The first lamp as a soft panel with a bright middle, which shows how the surface bends.
  float key = fourth(max(dot(mirror, to_key.xyz), 0.0)), fill = fourth(max(dot(mirror, to_fill.xyz), 0.0));
  c += key_light * (0.9 * fourth(fourth(key * key)) + 0.16 * key * key) + 0.12 * fill_light * fill * fill;
  fragment = vec4(sqrt(clamp(c, 0.0, 1.0)), cover);
}
