#include "frame.glsl"
#include "sun.glsl"
layout(location = 0) in vec3 vertex;
uniform mat4 pose;
void main() { gl_Position = vec4(2.0 * sun_place(vec3(pose * vec4(vertex, 1.0))) - 1.0, 1.0); }
