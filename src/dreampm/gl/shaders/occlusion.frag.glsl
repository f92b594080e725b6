#include "frame.glsl"
// Ambient occlusion at half size: M. McGuire et al., "The Alchemy Screen-Space Ambient Obscurance
// Algorithm" (2011), equation 10, over a spiral of taps.
uniform sampler2D depth;
uniform float reach;  // m
out vec4 fragment;

vec3 point(ivec2 at) {
  at = clamp(at, ivec2(0), ivec2(viewport.xy) - 1);
  return eye_point(vec2(at) + 0.5, eye_distance(texelFetch(depth, at, 0).r));
}
void main() {
  ivec2 here = 2 * ivec2(gl_FragCoord.xy);
  float raw = texelFetch(depth, min(here, ivec2(viewport.xy) - 1), 0).r;
  vec3 p = eye_point(vec2(here) + 0.5, eye_distance(raw));
  float pixels = reach * lens.x / -p.z;
  int wide = int(clamp(0.12 * pixels, 1.0, 6.0));
  // The normal from neighbours, on each axis the one of the same surface.
  vec3 r = point(here + ivec2(wide, 0)) - p, l = p - point(here - ivec2(wide, 0));
  vec3 u = point(here + ivec2(0, wide)) - p, d = p - point(here - ivec2(0, wide));
  vec3 n = normalize(cross(abs(r.z) < abs(l.z) ? r : l, abs(u.z) < abs(d.z) ? u : d));
  // Sixteen turns of the spiral in a square of 4x4, which the blur averages again.
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float turn = float((cell.x * 4 + cell.y * 7 + (cell.x * cell.y & 1) * 2) & 15) * 0.39269908;
  float sum = 0.0;
  int taps = raw < 1.0 ? 9 : 0;  // the far background needs none
  for (int k = 0; k < taps; ++k) {
    float share = (float(k) + 0.5) / 9.0;
    float angle = turn + float(k) * 2.3999632;
    ivec2 at = here + ivec2(share * min(pixels, 90.0) * vec2(cos(angle), sin(angle)));
    vec3 v = point(at) - p;
    float v2 = dot(v, v);
    float inside = max(1.0 - v2 / (reach * reach), 0.0);
    sum += inside * max(dot(v, n) - 0.04 * reach, 0.0) * inversesqrt(v2 + 1e-4 * reach * reach);
  }
  fragment = vec4(max(1.0 - 2.2 * sum / 9.0, 0.0), 0.0, 0.0, 1.0);
}
