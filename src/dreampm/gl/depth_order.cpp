#include "dreampm/gl/depth_order.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dreampm::gl {

std::span<const std::uint32_t> DepthOrder::front_to_back(std::span<const Vec3f> positions, const Camera& camera) {
  constexpr int layers = 255;
  constexpr std::uint8_t none = layers;  // for what is no number
  const Vec3f forward = camera.axes().forward;
  float low = INFINITY, high = -INFINITY;
  for (const Vec3f& p : positions)
    if (const float d = dot(p, forward); std::isfinite(d)) {
      low = std::min(low, d);
      high = std::max(high, d);
    }
  const float scale = high > low ? (layers - 0.5f) / (high - low) : 0;
  std::array<std::uint32_t, layers + 2> start{};
  layer_.resize(positions.size());
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const float d = dot(positions[k], forward);
    layer_[k] = std::isfinite(d) ? static_cast<std::uint8_t>((d - low) * scale) : none;
    ++start[layer_[k] + 1u];
  }
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  const std::size_t count = start[none];
  order_.resize(positions.size());
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (layer_[k] != none) order_[start[layer_[k]]++] = static_cast<std::uint32_t>(k);
  return std::span(order_).first(count);
}

}  // namespace dreampm::gl
