// Ambient occlusion at half size: M. McGuire et al., "The Alchemy Screen-Space Ambient Obscurance
// Algorithm" (2011), equation 10, over a spiral of taps.
uniform sampler2D depth;
flat in vec4 depths, extent;
out vec4 fragment;

vec3 point(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(extent.xy) - 1);
  float distance = depths.x / (depths.y - texelFetch(depth, at, 0).r * depths.z);
  return vec3((vec2(at) + 0.5 - 0.5 * extent.xy) * extent.z, -1.0) * distance;
}
void main() {
  ivec2 here = 2 * ivec2(gl_FragCoord.xy);
  vec3 p = point(here);
  float reach = extent.w, pixels = reach * depths.w / -p.z;
  int wide = int(clamp(0.12 * pixels, 1.0, 6.0));
  // The normal from neighbors, on each axis the one of the same surface.
  vec3 r = point(here + ivec2(wide, 0)) - p, l = p - point(here - ivec2(wide, 0));
  vec3 u = point(here + ivec2(0, wide)) - p, d = p - point(here - ivec2(0, wide));
  vec3 n = cross(abs(r.z) < abs(l.z) ? r : l, abs(u.z) < abs(d.z) ? u : d);
  n *= inversesqrt(max(dot(n, n), 1e-20));
  // Sixteen turns of the spiral in a square of 4x4, which the blur averages again.
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float turn = float((cell.x * 4 + cell.y * 7 + (cell.x * cell.y & 1) * 2) & 15) * 0.39269908;
  // The angle between taps is the golden one.
  vec2 way = vec2(cos(turn), sin(turn)) * min(pixels, 90.0);
  const mat2 next = mat2(-0.737369, 0.675490, -0.675490, -0.737369);
  const int taps = 7;
  float sum = 0.0, bias = 0.04 * reach, narrow = 1.0 / (reach * reach), least = 1e-4 * reach * reach;
  for (int k = 0; k < taps; ++k) {
    vec3 v = point(here + ivec2(way * ((float(k) + 0.5) / float(taps)))) - p;
    way = next * way;
    float v2 = dot(v, v);
    sum += max(1.0 - v2 * narrow, 0.0) * max(dot(v, n) - bias, 0.0) * inversesqrt(v2 + least);
  }
  fragment = vec4(max(1.0 - 2.2 * sum / float(taps), 0.0), 0.0, 0.0, 1.0);
}
