#include "background.glsl"
in vec3 ray;
flat in vec3 low, high;
out vec4 fragment;
void main() {
  fragment = vec4(mix(low, high, background_share(ray.y * inversesqrt(dot(ray, ray)))), 1.0);
}
