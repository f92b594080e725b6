flat in vec3 shown;
out vec4 fragment;
void main() { fragment = vec4(shown, 1.0); }
