#include "frame.glsl"
#include "particle.glsl"
flat out vec3 center;
void main() {
  center = vec3(view * vec4(position, 1.0));
  place_sphere(center, radius, 0.5);
}
