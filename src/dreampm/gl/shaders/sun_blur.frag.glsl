#include "frame.glsl"
// One direction of a Gaussian over what shades the floor. Red: how dark the shadow of matter is; green: the
// same times its height over the reach of soft shadows. The first pass reads the sun map.
uniform sampler2D source, darkness;
uniform vec2 stride;       // between taps, in texture coordinates
uniform int taps;          // on each side
uniform float from_depth;  // 1: source is the sun map
in vec2 uv;
out vec4 fragment;

vec2 matter(vec2 at) {
  vec2 v = texture(source, at).rg;
  float cover = v.x < 1.0 ? texture(darkness, at).r : 0.0;
  return mix(v, vec2(cover, cover * clamp(2.5 * (1.0 - v.x), 0.0, 1.0)), from_depth);
}
void main() {
  vec2 sum = matter(uv);
  float total = 1.0, bend = 2.0 / float(taps * taps);  // ends at two deviations
  for (int k = 1; k <= taps; ++k) {
    float w = exp(-bend * float(k * k));
    sum += w * (matter(uv + float(k) * stride) + matter(uv - float(k) * stride));
    total += 2.0 * w;
  }
  fragment = vec4(sum / total, 0.0, 1.0);
}
