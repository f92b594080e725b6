#include "frame.glsl"
#include "particle.glsl"
uniform float far;
flat out vec3 shown;
flat out vec2 ball;  // red of surface_splat.frag at the center; radius [m]
void main() {
  vec3 center = vec3(view * vec4(position, 1.0));
  place_sphere(center, radius, 0.5);
  shown = encode(particle_color());
  ball = vec2(far + center.z, radius);
}
