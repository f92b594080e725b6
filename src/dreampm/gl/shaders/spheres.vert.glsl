#include "frame.glsl"
#include "sun.glsl"
#include "particle.glsl"
// One point a sphere. Its color and the shadow on it are found here, once a sphere.
uniform sampler2DShadow sun_depth;
uniform sampler2D sun_darkness;
uniform float grain;  // how much size and brightness change from particle to particle, 0 to 1
flat out vec4 matter;  // encoded color; the middle row of the tile of light_ball.frag.glsl for its light

// How much of the first light arrives: four comparisons, each blurred over 2x2 texels.
float sunlight(vec3 world) {
  vec3 at = sun_place(world);
  at.z -= (2.5 * radius + sun_height.w) * sun_height.y;
  vec2 by = 1.5 * sun_height.w * sun_map.zw;
  float sum = texture(sun_depth, vec3(at.xy + vec2(-by.x, -by.y), at.z)) +
              texture(sun_depth, vec3(at.xy + vec2(by.x, -by.y), at.z)) +
              texture(sun_depth, vec3(at.xy + vec2(-by.x, by.y), at.z)) +
              texture(sun_depth, vec3(at.xy + vec2(by.x, by.y), at.z));
  return 1.0 - sun_height.z * texture(sun_darkness, at.xy).r * (1.0 - 0.25 * sum);
}
// A well-mixed hash (Wellons' lowbias32) as a number from -1 to 1.
float noise(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return float((x ^ (x >> 16)) >> 8) / 8388608.0 - 1.0;
}
void main() {
  vec3 center = vec3(view * vec4(position, 1.0));
  float r = radius * (1.0 + grain * noise(uint(gl_VertexID)));
  place_sphere(center, r, 1.0);
  vec3 color = particle_color() * (1.0 + grain * noise(uint(gl_VertexID) * 747796405u + 17u));
  float lit = sunlight(position);
  matter = vec4(encode(color), 64.0 * floor(7.0 * lit + 0.5) + 32.0);
}
