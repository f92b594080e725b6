#include "frame.glsl"
// One instance a segment: a strip as wide as a line and its soft edges.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 color;
uniform float half_width;  // pixels
out float across;
flat out vec4 shown;
void main() {
  vec4 a = view * vec4(from, 1.0), b = view * vec4(to, 1.0);
  // Ends behind the near plane move along the segment onto it.
  float limit = -1.001 * lens.y;
  if (a.z > limit && b.z < limit) a = mix(b, a, (limit - b.z) / (a.z - b.z));
  else if (b.z > limit && a.z < limit) b = mix(a, b, (limit - a.z) / (b.z - a.z));
  vec4 p = projection * a, q = projection * b;
  vec2 along = (q.xy / q.w - p.xy / p.w) * viewport.xy;
  along = dot(along, along) > 1e-8 ? normalize(along) : vec2(1.0, 0.0);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  vec4 at = gl_VertexID < 2 ? p : q;
  across = side * (half_width + 1.0);
  at.xy += vec2(-along.y, along.x) * across * 2.0 * viewport.zw * at.w;
  at.z -= 5e-5 * at.w;  // in front of the floor that an edge lies on
  gl_Position = a.z > limit ? vec4(2.0, 2.0, 2.0, 1.0) : at;
  shown = color;
}
