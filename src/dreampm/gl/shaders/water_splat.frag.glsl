#include "frame.glsl"
// A sphere of liquid. Red: how much nearer than `far` its front is [m]; the largest is kept. Alpha:
// the path of the view through it [m], which is added up over spheres in front of opaque matter.
uniform sampler2D depth;
uniform float radius, far;
uniform float fill;  // share of a sphere's volume that is the particle's own
flat in vec3 center;
out vec4 fragment;
void main() {
  vec2 q = 2.0 * gl_PointCoord - 1.0;
  float r2 = dot(q, q);
  if (r2 > 1.0) discard;
  float front = radius * sqrt(1.0 - r2);
  float opaque = eye_distance(texelFetch(depth, min(ivec2(2.0 * gl_FragCoord.xy), ivec2(viewport.xy) - 1), 0).r);
  float path = clamp(opaque + center.z + front, 0.0, 2.0 * front);
  fragment = vec4(far + center.z + front, 0.0, 0.0, fill * path);
}
