#include "frame.glsl"
#include "particle.glsl"
uniform float far;   // red counts from here towards the eye [m]
uniform float fill;  // share of a sphere's volume that is the particle's own
flat out vec3 ball;  // red at its center, its radius, path along its diameter [m]
void main() {
  vec3 center = vec3(view * vec4(position, 1.0));
  place_sphere(center, radius, 0.5);
  ball = vec3(far + center.z, radius, 2.0 * fill * radius);
}
