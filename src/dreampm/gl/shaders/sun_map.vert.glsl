#include "frame.glsl"
#include "sun.glsl"
#include "particle.glsl"
void main() {
  vec3 at = sun_place(position);
  gl_Position = vec4(2.0 * at - 1.0, 1.0);
  gl_PointSize = max(2.0 * radius / sun_height.w, 1.0);
  if (!(at.z < 1.0)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
