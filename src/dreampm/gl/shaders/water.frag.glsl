// Puts the liquid over the picture: reflection by Schlick's fit of Fresnel's formula, refraction of
// what lies behind, absorption by Beer and Lambert. All directions are in the eye's space.
uniform sampler2D surface, field;  // surface_normal.frag, surface_filter.frag
uniform sampler2D behind, depth;   // what is drawn so far
in vec2 uv, slope;
flat in vec4 depths, extinction, matter, to_key, to_fill, up;
flat in vec3 key_light, fill_light, sky_near, sky_far, light_middle, light_slope, ground;
flat in vec2 pixels;
out vec4 fragment;

float opaque_at(vec2 at) {
  vec2 size = vec2(textureSize(depth, 0));
  return depths.x / (depths.y - texelFetch(depth, ivec2(clamp(at, 0.0, 0.9999) * size), 0).r * depths.z);
}
vec2 place(vec3 q) { return 0.5 + q.xy / -q.z * pixels; }
float fourth(float x) { return x * x * x * x; }

void main() {
  vec4 f = texture(field, uv), s = texture(surface, uv);
  float cover = min(smoothstep(0.45, 0.6, f.g), smoothstep(0.1, 0.9, s.a));
  if (cover <= 0.0) discard;
  s /= s.a;
  vec2 n_xy = s.rg;
  float z = depths.w - s.b, opaque = opaque_at(uv);
  if (z > opaque) discard;
  cover *= min((opaque - z) / to_fill.a, 1.0);  // else what comes out of the liquid has a ragged edge
  vec3 n = vec3(n_xy, sqrt(max(1.0 - dot(n_xy, n_xy), 0.0))), p = vec3(slope, -1.0) * z;
  float slant = length(vec3(slope, 1.0));  // of the view, to its axis
  vec3 ray = vec3(slope, -1.0) / slant;
  float facing = clamp(-dot(n, ray), 0.0, 1.0);

  // Where the refracted ray leaves the liquid, at the latest on the floor, and what is seen there.
  // Bent by less than half of what it is: what stands in rough water would look torn.
  vec3 bent = normalize(mix(ray, refract(ray, n, 1.0 / matter.a), 0.4));
  float path = f.a * slant, height_here = max(up.w + dot(p, up.xyz), 0.0), fall = -dot(bent, up.xyz);
  path = min(path, height_here / max(fall, 1e-3));
  // What stands in the liquid ends the ray before: it is followed across the picture until it is behind
  // what is drawn there.
  float before = 0.0, after = 0.0;  // along the ray [m]
  vec2 at = uv;
  for (int k = 1; k <= 3 && after <= 0.0; ++k) {
    float to = 0.327 * float(k) * path;  // short of the floor, on which the ray may end
    vec3 q = p + bent * to;
    vec2 there = place(q);
    float found = opaque_at(there);
    if (found < z) break;  // something before the liquid
    if (found < -q.z) after = to;
    else before = to, at = there;
  }
  if (after > 0.0) {
    vec2 met = at;
    float gap = path;
    for (int k = 0; k < 2; ++k) {
      float to = 0.5 * (before + after);
      vec3 q = p + bent * to;
      vec2 there = place(q);
      float off = -q.z - opaque_at(there);
      if (off > 0.0) after = to, met = there, gap = off;
      else before = to, at = there;
    }
    // Where it only passes behind an edge, what it meets was not drawn: as beside the edge.
    if (gap < 0.2 * path) at = met, path = after;
  }
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
  // A dark horizon under a bright sky, and the first lamp as a panel with a bright middle: they show how the
  // surface bends.
  vec3 sky = mix(0.3 * sky_far, sky_near, smoothstep(0.0, 0.7, height));
  sky = mix(sky, ground, smoothstep(0.0, 0.25, -height));
  float key = dot(mirror, to_key.xyz), fill = max(dot(mirror, to_fill.xyz), 0.0);
  sky += 1.6 * key_light * smoothstep(0.82, 0.94, key);
  c = mix(c, sky, min(1.4 * fresnel, 0.75));
  float shine = fourth(fourth(max(key, 0.0)));
  c += 0.9 * key_light * fourth(shine) + 0.12 * fill_light * fourth(fill * fill);
  fragment = vec4(sqrt(clamp(c, 0.0, 1.0)), cover);
}
