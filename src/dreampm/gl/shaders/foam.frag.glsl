#include "frame.glsl"
// A soft disc, darker to its edge.
flat in vec4 matter;
out vec4 fragment;
void main() {
  vec2 q = 2.0 * gl_PointCoord - 1.0;
  float r2 = dot(q, q);
  if (r2 > 1.0) discard;
  fragment = vec4(encode(matter.rgb * (1.0 - 0.25 * r2)), matter.a * (1.0 - r2 * r2));
}
