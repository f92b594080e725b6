#include "frame.glsl"
#include "particle.glsl"
uniform float far;   // red counts from here towards the eye [m]
uniform float fill;  // share of a sphere's volume that is the particle's own
flat out vec4 ball;  // red at its center, its radius, path along its diameter [m]; distance of the center
#ifdef BEFORE_OPAQUE
flat out vec3 depths;  // for eye_distance: near far, far, far - near
#endif
void main() {
  vec3 center = vec3(view * vec4(position, 1.0));
  place_sphere(center, radius, 0.5);
  ball = vec4(far + center.z, radius, 2.0 * fill * radius, -center.z);
#ifdef BEFORE_OPAQUE
  depths = vec3(lens.y * lens.z, lens.z, lens.z - lens.y);
#endif
}
