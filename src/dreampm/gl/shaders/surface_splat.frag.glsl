// A sphere of matter. Red: how much nearer than `far` its front is [m]; the largest is kept. Alpha:
// the path of the view through it [m], which is added up.
flat in vec3 ball;
out vec4 fragment;
void main() {
  vec2 q = gl_PointCoord - 0.5;
  float r2 = dot(q, q);
  if (r2 > 0.25) discard;
  float half_chord = sqrt(1.0 - 4.0 * r2);
  fragment = vec4(ball.x + ball.y * half_chord, 0.0, 0.0, ball.z * half_chord);
}
