#include "frame.glsl"
// How a white ball looks, for each normal that faces the eye: spheres look their light up here. Tiles
// of `side` x `side` texels stand above one another, from no light of the first lamp to all of it.
// Lights count as far away: their directions are those at the middle of the domain. Red, green, blue:
// light, encoded; alpha: the highlight.
uniform int side, levels;
out vec4 fragment;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float lit = float(at.y / side) / float(levels - 1);
  vec2 q = (vec2(at.x, at.y % side) + 0.5) * (2.0 / float(side)) - 1.0;
  q *= min(1.0, inversesqrt(max(dot(q, q), 1e-6)));
  vec3 n = vec3(q, sqrt(max(1.0 - dot(q, q), 0.0)));
  float key = dot(n, eye_key.xyz);
  vec3 light = ambient(dot(n, eye_up.xyz)) + light_color[0].rgb * (lit * max(key, 0.0)) +
               light_color[1].rgb * max(dot(n, eye_fill.xyz), 0.0);
  light *= 0.7 + 0.3 * n.z;  // so that the outlines of neighbors show
  fragment = vec4(encode(light), lit * pow(max(2.0 * key * n.z - eye_key.z, 1e-3), 16.0));
}
