// A sphere of liquid. Red: how much nearer than `far` its front is [m]; the largest is kept. Alpha:
// the path of the view through it [m], which is added up over spheres in front of opaque matter.
flat in vec4 ball;
out vec4 fragment;
#ifdef BEFORE_OPAQUE
uniform sampler2D depth;
flat in vec3 depths;
#endif
void main() {
  vec2 q = gl_PointCoord - 0.5;
  float r2 = dot(q, q);
  if (r2 > 0.25) discard;
  float half_chord = sqrt(1.0 - 4.0 * r2);
  float path = ball.z * half_chord;
#ifdef BEFORE_OPAQUE
  ivec2 at = min(ivec2(2.0 * gl_FragCoord.xy), textureSize(depth, 0) - 1);
  float opaque = depths.x / (depths.y - texelFetch(depth, at, 0).r * depths.z);
  path *= clamp((opaque - ball.w) / (ball.y * half_chord + 1e-9) * 0.5 + 0.5, 0.0, 1.0);
#endif
  fragment = vec4(ball.x + ball.y * half_chord, 0.0, 0.0, path);
}
