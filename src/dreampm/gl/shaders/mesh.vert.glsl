#include "frame.glsl"
#include "sun.glsl"
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 normal;
uniform mat4 pose;
out vec3 world, facing;
void main() {
  world = vec3(pose * vec4(vertex, 1.0));
  facing = mat3(pose) * normal;
  gl_Position = projection * view * vec4(world, 1.0);
}
