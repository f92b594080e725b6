// A sphere's front. All that could be found before is: this runs for every pixel of every particle.
#ifndef ROUND
#define ROUND 1.0  // how far the normal at its edge leans away from the eye, of that of a sphere
#endif
flat in vec4 matter;
uniform sampler2D light_ball;
uniform float gloss, opacity;
out vec4 fragment;

void main() {
  vec2 q = gl_PointCoord - 0.5;
  float r2 = dot(q, q);
  if (r2 > 0.25) discard;
  vec4 light = texelFetch(light_ball, ivec2(ROUND * vec2(64.0, -64.0) * q + vec2(32.0, matter.a)), 0);
  fragment = vec4(matter.rgb * light.rgb + vec3(gloss * light.a), opacity);
}
