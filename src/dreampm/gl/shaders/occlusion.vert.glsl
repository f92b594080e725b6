#include "frame.glsl"
// A triangle over the whole target, with what all pixels need.
uniform float reach;     // m
flat out vec4 depths;    // near far, far, far - near of the projection; pixels per slope
flat out vec4 extent;    // width, height of the frame [pixels], 1/pixels per slope, reach
void main() {
  vec2 at = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  depths = vec4(lens.y * lens.z, lens.z, lens.z - lens.y, lens.x);
  extent = vec4(viewport.xy, 1.0 / lens.x, reach);
  gl_Position = vec4(at, 1.0, 1.0);
}
