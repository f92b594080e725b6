// The sun map: for each spot of the floor, the highest matter on the ray from there to the first
// light, whose rays count as parallel. It is kept as a depth, 1 - height, so that the depth test
// finds the highest.
vec3 sun_place(vec3 world) {
  float rise = world.y - sun_height.x;
  vec2 foot = world.xz - sun.xz / sun.y * rise;
  return vec3((foot - sun_map.xy) * sun_map.zw, 1.0 - rise * sun_height.y);
}
