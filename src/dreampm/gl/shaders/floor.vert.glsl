#include "frame.glsl"
#include "sun.glsl"
// A square of floor about the domain, wide enough to fade within it. What is the same at all pixels
// is found here.
out vec2 tile_at;                        // in tiles
out vec3 to_eye;
out vec2 sun_at, place;                 // in the sun map; from the middle over the reach
flat out vec3 bright, dark, grout;       // tiles, encoded
flat out vec3 sky_light, lamp_light;     // linear, without shadows: from the sky and the second light; the first
flat out vec3 low, high;                 // background, encoded
flat out vec3 shape;                     // side of a tile, reach of the floor, darkness of shadows
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 middle = vec3(floor_shape.y, sun_height.x, floor_shape.z);
  vec3 world = middle;
  world.xz += corner * floor_shape.w;
  sun_at = sun_place(world).xy;
  bright = encode(floor_bright.rgb);
  dark = encode(floor_dark.rgb);
  grout = encode(floor_grout.rgb);
  float key = max(normalize(light_position[0].xyz - middle).y, 0.0);
  float fill = max(normalize(light_position[1].xyz - middle).y, 0.0);
  sky_light = 0.72 * (ambient(1.0) + light_color[1].rgb * fill);
  lamp_light = 0.72 * light_color[0].rgb * key;
  low = encode(background_low.rgb);
  high = encode(background_high.rgb);
  shape = vec3(floor_shape.x, floor_shape.w, sun_height.z);
  gl_Position = projection * view * vec4(world, 1.0);
  to_eye = eye.xyz - world;
  place = corner;
  tile_at = world.xz / floor_shape.x;
}
