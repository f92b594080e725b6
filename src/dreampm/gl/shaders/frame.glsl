// What all shaders of a frame share; renderer.cpp fills it (FrameBlock).
layout(std140) uniform Frame {
  mat4 view;               // world to eye: x right, y up, -z forward
  mat4 projection;
  vec4 eye;                // world
  vec4 viewport;           // width, height, 1/width, 1/height [pixels]
  vec4 lens;               // pixels per slope, near, far, width/height
  vec4 light_position[2];  // world
  vec4 light_color[2];     // linear
  vec4 ambient_middle;     // linear: half of the sum of the light from above and from below
  vec4 ambient_slope;      // and half of their difference
  vec4 eye_up;             // in the eye's space: up, and towards the lights from the middle of the domain
  vec4 eye_key, eye_fill;
  vec4 sun;                // towards the first light from the middle of the domain
  vec4 sun_map;            // low x and z of the patch of floor that the sun map covers, 1/size of it
  vec4 sun_height;         // y of the floor, 1/height of the map, darkness of shadows, a texel [m]
  vec4 background_low, background_high, sky_low, sky_high;
  vec4 floor_bright, floor_dark, floor_grout;
  vec4 floor_shape;        // tile [m], x and z of the middle, radius where it has faded
};

// Square and root stand for sRGB's curve: near enough to it, and cheap where a processor draws.
vec3 encode(vec3 linear) { return sqrt(clamp(linear, 0.0, 1.0)); }
vec3 decode(vec3 shown) { return shown * shown; }

// Distance in front of the eye along the axis of view, from the depth buffer's 0 to 1.
float eye_distance(float depth) {
  float near = lens.y, far = lens.z;
  return near * far / (far - depth * (far - near));
}
// The point of the eye's space at pixel `at` and that distance.
vec3 eye_point(vec2 at, float distance) {
  return vec3((at - 0.5 * viewport.xy) / lens.x, -1.0) * distance;
}
vec3 to_world(vec3 eye_direction) { return eye_direction * mat3(view); }  // the transpose turns back

vec3 sky(vec3 direction) {
  float up = clamp(direction.y, 0.0, 1.0);
  return mix(sky_low.rgb, sky_high.rgb, sqrt(up) * (1.5 - 0.5 * up));
}
vec3 ambient(float up) { return ambient_middle.rgb + ambient_slope.rgb * up; }
