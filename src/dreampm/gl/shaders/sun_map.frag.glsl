// How dark the shadow of this matter is, where it is the highest.
uniform float darkness;
out float fragment;
void main() { fragment = darkness; }
