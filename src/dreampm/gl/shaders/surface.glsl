// The normal's x and y in the eye's space (surface_normal.frag), a mean over a few texels: where the
// surface steps, single texels are rough.
uniform float apart;  // of the filter's taps [texels]
vec2 mean_normal(sampler2D surface, vec2 uv) {
  vec2 by = 1.1 * apart / vec2(textureSize(surface, 0));
  vec4 sum = texture(surface, uv + vec2(by.x, 0.4 * by.y)) + texture(surface, uv + vec2(-0.4 * by.x, by.y)) +
             texture(surface, uv + vec2(-by.x, -0.4 * by.y)) + texture(surface, uv + vec2(0.4 * by.x, -by.y));
  return sum.rg / max(sum.a, 0.25);
}
