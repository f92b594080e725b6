// Colors of particles at the surface, blended by how near they are to it: alpha is the weight.
uniform sampler2D field;
flat in vec3 shown;
flat in vec2 ball;
out vec4 fragment;
void main() {
  vec2 q = gl_PointCoord - 0.5;
  float r2 = 4.0 * dot(q, q);
  float below = abs(texelFetch(field, ivec2(gl_FragCoord.xy), 0).r - ball.x) / (2.0 * ball.y);
  if (r2 > 1.0 || below > 1.0) discard;
  float weight = (1.0 - r2) * (1.0 - below);
  fragment = vec4(shown * weight, weight);
}
