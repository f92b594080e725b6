// One direction of a Gaussian over what shades the floor. Red: how dark the shadow of matter is; green: the
// same times its height over the reach of soft shadows. The first pass reads the sun map.
uniform sampler2D source;
#ifdef FROM_DEPTH
uniform sampler2D darkness;
#endif
uniform vec2 stride;       // between taps, in texture coordinates
uniform int taps;          // on each side
in vec2 uv;
out vec4 fragment;

vec2 matter(vec2 at) {
  vec2 v = texture(source, at).rg;
#ifdef FROM_DEPTH
  float dark = v.x < 1.0 ? texture(darkness, at).r : 0.0;
  v = vec2(dark, dark * clamp(2.5 * (1.0 - v.x), 0.0, 1.0));
#endif
  return v;
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
