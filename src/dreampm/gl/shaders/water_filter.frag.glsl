#include "frame.glsl"
// One direction of the narrow-range filter (Truong and Yuksel 2018, section 4). A neighbour that is
// nearer than the range belongs to another surface and counts for nothing, and so does its partner
// on the other side; one that is farther, the background included, counts as at the range's far
// end, so that outlines stay round. The range grows with what was found within it, so that slopes
// are smoothed as flat parts are. Alpha is smoothed by the same weights without ranges.
uniform sampler2D field;
uniform ivec2 along;
uniform float far, range, reach;  // m: plane of red = 0, half of the range, half of the filter's width
out vec4 fragment;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec4 mine = texelFetch(field, here, 0);
  float z = mine.r, low = z - range, high = z + range;
  float pixels = 0.5 * reach * lens.x / max(far - z, 1e-6);
  int taps = z > 0.0 ? int(clamp(pixels, 2.0, 12.0)) : 0;
  float bend = 2.0 / float(taps * taps + 1);  // a Gaussian that ends at two deviations
  float sum = z, total = 1.0, path = mine.a, path_total = 1.0;
  for (int k = 1; k <= taps; ++k) {
    vec4 a = texelFetch(field, here + k * along, 0), b = texelFetch(field, here - k * along, 0);
    float g = exp(-float(k * k) * bend), w = max(a.r, b.r) > high ? 0.0 : g;
    float p = a.r < low ? z - range : a.r, q = b.r < low ? z - range : b.r;
    if (w > 0.0) {
      if (a.r >= low) { high = max(high, a.r + range); low = min(low, a.r - range); }
      if (b.r >= low) { high = max(high, b.r + range); low = min(low, b.r - range); }
    }
    sum += w * (p + q);
    total += 2.0 * w;
    path += g * (a.a + b.a);
    path_total += 2.0 * g;
  }
  fragment = vec4(sum / total, 0.0, 0.0, path / path_total);
}
