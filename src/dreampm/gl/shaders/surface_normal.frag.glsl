#include "frame.glsl"
// Red, green: x and y of the normal in the eye's space; blue: the field's red; alpha: 1 where there is
// matter. All is zero elsewhere, so that it can be read between texels.
uniform sampler2D field;
uniform float far;
uniform ivec2 low_corner, high_corner;  // of what is drawn this frame
out vec4 fragment;

vec3 point(ivec2 at) {
  ivec2 inside = clamp(at, low_corner, high_corner);
  float z = texelFetch(field, inside, 0).r;
  return z > 0.0 && inside == at ? eye_point(2.0 * vec2(at) + 1.0, far - z) : vec3(0.0, 0.0, -1e6);
}
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  float z = texelFetch(field, here, 0).r;
  vec3 p = point(here);
  vec3 r = point(here + ivec2(1, 0)) - p, l = p - point(here - ivec2(1, 0));
  vec3 u = point(here + ivec2(0, 1)) - p, d = p - point(here - ivec2(0, 1));
  // On each axis the neighbor of the same surface; of two, their mean.
  vec3 dx = abs(abs(r.z) - abs(l.z)) < 0.5 * min(abs(r.z), abs(l.z)) ? 0.5 * (r + l) : abs(r.z) < abs(l.z) ? r : l;
  vec3 dy = abs(abs(u.z) - abs(d.z)) < 0.5 * min(abs(u.z), abs(d.z)) ? 0.5 * (u + d) : abs(u.z) < abs(d.z) ? u : d;
  vec3 n = cross(dx, dy);
  float size = dot(n, n);
  n = n.z > 0.0 && size > 0.0 && size < 1e12 ? n * inversesqrt(size) : vec3(0.0, 0.0, 1.0);
  fragment = z > 0.0 ? vec4(n.xy, z, 1.0) : vec4(0.0);
}
