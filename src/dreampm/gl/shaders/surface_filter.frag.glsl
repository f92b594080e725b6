#include "frame.glsl"
// One direction of the narrow-range filter (Truong and Yuksel 2018, section 4). A neighbor that is
// nearer than the range belongs to another surface and counts for nothing; its partner on the other
// side does count, or single particles would show along every limb that hides another. One that is
// farther, the background included, counts as a little behind, so that outlines stay round. The range
// grows with what was found within it, so that slopes are smoothed as flat parts are. Green: how much of the neighborhood is liquid, for soft outlines.
// Alpha: the path, smoothed over all that is liquid.
uniform sampler2D field;
// One tap further; over some texels near the eye, where the front of one sphere is smooth.
uniform ivec2 along;
uniform ivec2 spread;  // taps for soft outlines: as wide as it takes to even out single particles [pixels]
// m: the plane of red = 0; half of the range; what counts as farther; half of the filter's width
uniform float far, range, behind, reach;
uniform float first;                      // 1: the first direction
uniform ivec2 low_corner, high_corner;  // of what is drawn this frame
out vec4 fragment;

vec4 texel_at(ivec2 at) { return texelFetch(field, clamp(at, low_corner, high_corner), 0); }
float liquid(vec4 texel) { return mix(texel.g, texel.r > 0.0 ? 1.0 : 0.0, first); }

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  vec4 mine = texelFetch(field, here, 0);
  ivec2 axis = sign(along), near = spread.x * axis, away = spread.y * axis;
  float cover = 0.3 * liquid(mine) +
                0.22 * (liquid(texel_at(here + near)) + liquid(texel_at(here - near))) +
                0.13 * (liquid(texel_at(here + away)) + liquid(texel_at(here - away)));
  float z = mine.r, low = z - range, high = z + range;
  float pixels = 0.5 * reach * lens.x / max(far - z, 1e-6) / float(abs(along.x + along.y));
  int taps = z > 0.0 ? int(clamp(pixels, 2.0, 8.0)) : 0;
  float narrow = 1.0 / float((taps + 1) * (taps + 1));
  float sum = z, total = 1.0, path = mine.a, path_total = 1.0;
  for (int k = 1; k <= taps; ++k) {
    ivec2 by = k * along;
    vec4 a = texel_at(here + by), b = texel_at(here - by);
    float g = 1.0 - float(k * k) * narrow;
    g *= g;  // nearly a Gaussian, and cheaper
    float v = a.r > high ? 0.0 : g, w = b.r > high ? 0.0 : g;
    float p = a.r < low ? z - behind : a.r, q = b.r < low ? z - behind : b.r;
    if (v * w > 0.0) {
      if (a.r >= low) { high = max(high, a.r + range); low = min(low, a.r - range); }
      if (b.r >= low) { high = max(high, b.r + range); low = min(low, b.r - range); }
    }
    sum += v * p + w * q;
    total += v + w;
    float c = a.r > 0.0 ? g : 0.0, d = b.r > 0.0 ? g : 0.0;
    path += c * a.a + d * b.a;
    path_total += c + d;
  }
  fragment = vec4(sum / total, cover, 0.0, path / path_total);
}
