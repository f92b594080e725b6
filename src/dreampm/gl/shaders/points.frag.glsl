flat in vec3 shown;
uniform float opacity;
out vec4 fragment;
void main() { fragment = vec4(shown, opacity); }
