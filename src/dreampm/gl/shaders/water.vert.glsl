#include "frame.glsl"
// A triangle over the whole target; what all pixels need is found here.
uniform float far;
uniform vec3 absorption, tint;     // 1/m, sRGB
uniform float cloudiness, refractive_index, softness;
out vec2 uv;
out vec2 slope;                    // of the view, sideways and up
flat out vec4 depths;              // near far, far, far - near of the projection; `far` of the field
flat out vec4 extinction, matter;  // absorption, cloudiness; linear tint, refractive index
flat out vec4 to_key, to_fill;     // lights, in the eye's space; w: reflectance at right angles, softness [m]
flat out vec4 up;                  // in the eye's space; height of the eye over the floor
flat out vec3 key_light, fill_light, sky_near, sky_far, light_middle, light_slope, ground;
flat out vec2 pixels;              // 1/width, 1/height, times the focal length
void main() {
  uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  slope = (uv - 0.5) * viewport.xy / lens.x;
  depths = vec4(lens.y * lens.z, lens.z, lens.z - lens.y, far);
  extinction = vec4(absorption, cloudiness);
  matter = vec4(decode(tint), refractive_index);
  float r = (refractive_index - 1.0) / (refractive_index + 1.0);
  to_key = vec4(eye_key.xyz, r * r);
  to_fill = vec4(eye_fill.xyz, softness);
  up = vec4(eye_up.xyz, eye.y - sun_height.x);
  key_light = light_color[0].rgb;
  fill_light = light_color[1].rgb;
  sky_near = sky_low.rgb;
  sky_far = sky_high.rgb;
  light_middle = ambient_middle.rgb;
  light_slope = ambient_slope.rgb;
  ground = 0.6 * floor_bright.rgb * (ambient(1.0) + 0.7 * key_light);
  pixels = lens.x * viewport.zw;
  gl_Position = vec4(2.0 * uv - 1.0, 1.0, 1.0);
}
