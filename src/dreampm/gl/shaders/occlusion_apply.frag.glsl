// Multiplies what is drawn; the root, as colors are kept encoded, and half of the light is direct.
uniform sampler2D source;
in vec2 uv;
out vec4 fragment;
void main() {
  float open = texture(source, uv).r;
  fragment = vec4(vec3(sqrt(0.25 + 0.75 * open)), 1.0);
}
