#include "background.glsl"
uniform sampler2D soft_shadow, softer_shadow;  // sun_blur.frag: a narrow and a wide blur
in vec3 to_eye;
in vec2 tile_at, sun_at, place;
flat in vec3 bright, dark, grout, sky_light, lamp_light, low, high, shape;
out vec4 fragment;

void main() {
  // A pixel of a tile's pattern, with the grout between tiles blended by the share of the pixel that
  // it takes: it does not flicker.
  vec2 wide = fwidth(tile_at) + 1e-6;
  vec2 cell = floor(tile_at), edge = abs(tile_at - cell - 0.5);
  vec2 line = clamp((edge - 0.4875) / wide + 0.5, 0.0, 1.0) * min(vec2(1.0), 0.025 / wide + 0.1);
  float blur = smoothstep(0.25, 0.8, max(wide.x, wide.y));
  float odd = mix(fract(0.5 * (cell.x + cell.y)) * 2.0, 0.5, blur);
  vec3 tile = mix(mix(bright, dark, odd), grout, max(line.x, line.y) * (1.0 - blur));

  // What touches the floor throws a sharper shadow than what is high above it, and takes the light
  // of the sky as well.
  vec2 narrow = texture(soft_shadow, sun_at).rg, broad = texture(softer_shadow, sun_at).rg;
  float height = broad.g / max(broad.r, 1e-3);
  float shade = mix(narrow.r, broad.r, clamp(2.0 * height, 0.0, 1.0));
  vec3 light = sky_light * (1.0 - 0.45 * max(narrow.r - narrow.g, 0.0)) + lamp_light * (1.0 - shape.z * shade);

  float gone = smoothstep(0.0625, 0.94, dot(place, place));
  vec3 behind = mix(low, high, background_share(-to_eye.y * inversesqrt(dot(to_eye, to_eye))));
  fragment = vec4(mix(tile * sqrt(light), behind, gone), 1.0);
}
