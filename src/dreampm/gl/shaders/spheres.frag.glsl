// A sphere's front. All that could be found before is: this runs for every pixel of every particle.
flat in vec4 matter;
uniform sampler2D light_ball;
uniform float gloss, opacity;
out vec4 fragment;
#ifdef EXACT_DEPTH
#include "frame.glsl"
flat in vec2 ball;
#endif

void main() {
  vec2 q = gl_PointCoord - 0.5;
  float r2 = dot(q, q);
  if (r2 > 0.25) discard;
  vec4 light = texelFetch(light_ball, ivec2(vec2(64.0, -64.0) * q + vec2(32.0, matter.a)), 0);
  fragment = vec4(matter.rgb * light.rgb + vec3(gloss * light.a), opacity);
#ifdef EXACT_DEPTH
  float front = ball.x - ball.y * sqrt(1.0 - 4.0 * r2);
  gl_FragDepth = (lens.z - lens.y * lens.z / front) / (lens.z - lens.y);
#endif
}
