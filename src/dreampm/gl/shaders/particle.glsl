// The inputs of every shader of particles.
layout(location = 0) in vec3 position;
layout(location = 1) in float value;
layout(location = 2) in vec4 color;
uniform float radius;
uniform vec3 base_color;          // sRGB
uniform vec3 color_source;        // one of: base color, value, color
uniform vec2 value_range;         // least, 1/(most - least)
uniform vec3 scale_terms[7];      // color_scale.h

vec3 particle_color() {
  float t = (value - value_range.x) * value_range.y;
  t = t > 0.0 ? min(t, 1.0) : 0.0;  // what is not a number, too
  vec3 c = scale_terms[6];
  for (int k = 5; k >= 0; --k) c = c * t + scale_terms[k];
  return decode(clamp(color_source.x * base_color + color_source.y * c + color_source.z * color.rgb, 0.0, 1.0));
}
// Puts the point at `center` of the eye's space, so wide that its circle is the outline of a sphere,
// in pixels of a target that has `scale` times the frame's.
void place_sphere(vec3 center, float r, float scale) {
  float z = -center.z;
  gl_Position = vec4(projection[0].x * center.x, projection[1].y * center.y,
                     projection[2].z * center.z + projection[3].z, z);
  gl_PointSize = max(2.0 * r * lens.x * scale * inversesqrt(max(z * z - r * r, 1e-12)), 1.0);
  // What is not a number, or around the eye, goes outside of the picture.
  if (!(z > max(lens.y, 1.001 * r))) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
