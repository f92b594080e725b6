// The mean of 4x4 taps on the same surface.
uniform sampler2D source, depth;
flat in vec4 depths, extent;
out vec4 fragment;
float distance_at(ivec2 at) {
  return depths.x / (depths.y - texelFetch(depth, min(2 * at, ivec2(extent.xy) - 1), 0).r * depths.z);
}
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), most = textureSize(source, 0) - 1;
  float z = distance_at(here), narrow = 30.0 / z, sum = 0.0, total = 0.0;
  for (int y = -2; y < 2; ++y)
    for (int x = -2; x < 2; ++x) {
      ivec2 at = clamp(here + ivec2(x, y), ivec2(0), most);
      float w = max(1.0 - narrow * abs(distance_at(at) - z), 1e-3);
      sum += w * texelFetch(source, at, 0).r;
      total += w;
    }
  fragment = vec4(sum / total, 0.0, 0.0, 1.0);
}
