#include "frame.glsl"
#include "particle.glsl"
flat out vec3 shown;
void main() {
  vec3 center = vec3(view * vec4(position, 1.0));
  place_sphere(center, radius, 1.0);
  gl_PointSize = clamp(gl_PointSize, 2.0, 4.0);
  shown = encode(particle_color());
}
