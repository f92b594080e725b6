// The mean of neighbors on the same surface, after the filter's two directions: those go in strides, so that
// columns and rows between them know nothing of one another and would show as hatching.
uniform sampler2D field;  // surface_filter.frag
uniform ivec2 wide;       // texels on each side
uniform float range;      // m: what is farther off is another surface
uniform ivec2 low_corner, high_corner;  // of what is drawn this frame
out vec4 fragment;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  float z = texelFetch(field, here, 0).r, sum = 0.0, total = 0.0, cover = 0.0, path = 0.0, liquid = 0.0, all = 0.0;
  for (int y = -wide.y; y <= wide.y; ++y)
    for (int x = -wide.x; x <= wide.x; ++x) {
      vec4 t = texelFetch(field, clamp(here + ivec2(x, y), low_corner, high_corner), 0);
      float w = float((wide.x + 1 - abs(x)) * (wide.y + 1 - abs(y)));
      float same = abs(t.r - z) < range ? w : 0.0, wet = t.r > 0.0 ? w : 0.0;
      sum += same * t.r;
      total += same;
      path += wet * t.a;
      liquid += wet;
      cover += w * t.g;
      all += w;
    }
  fragment = vec4(z > 0.0 ? sum / total : 0.0, cover / all, 0.0, path / max(liquid, 1.0));
}
