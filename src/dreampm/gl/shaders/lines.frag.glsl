uniform float half_width;
in float across;
flat in vec4 shown;
out vec4 fragment;
void main() { fragment = vec4(shown.rgb, shown.a * clamp(half_width + 0.5 - abs(across), 0.0, 1.0)); }
