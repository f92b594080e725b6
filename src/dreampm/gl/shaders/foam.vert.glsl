#include "frame.glsl"
#include "particle.glsl"
// One point a ball, of the radius `radius + value`. One smaller than a pixel is as wide as one and covers
// its share of it.
uniform float opacity;
flat out vec4 matter;  // linear color in plain light, opacity
void main() {
  vec3 center = vec3(view * vec4(position, 1.0));
  float r = radius + value;
  place_sphere(center, r, 1.0);
  float wide = 2.0 * r * lens.x * inversesqrt(max(center.z * center.z - r * r, 1e-12));
  gl_PointSize = max(gl_PointSize, 1.5);
  float covered = min(1.0, wide * wide / (gl_PointSize * gl_PointSize));
  // Many balls on each other throw light to all sides: as bright from below as from above.
  vec3 light = ambient(0.5) + 0.45 * light_color[0].rgb + 0.2 * light_color[1].rgb;
  vec4 own = color_source.z > 0.5 ? color : vec4(base_color, opacity);
  matter = vec4(decode(own.rgb) * light, own.a * covered);
}
