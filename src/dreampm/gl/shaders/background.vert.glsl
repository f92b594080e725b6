#include "frame.glsl"
// A triangle over the whole target, at the far plane, with the way that the eye looks.
out vec3 ray;
flat out vec3 low, high;  // encoded; read once here and not at every pixel
void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  ray = to_world(vec3(at.x * lens.w, at.y, -2.0 * lens.x * viewport.w) * 0.5);
  low = encode(background_low.rgb);
  high = encode(background_high.rgb);
  gl_Position = vec4(at, 1.0, 1.0);
}
