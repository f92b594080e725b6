// The order in which opaque particles are drawn. Plain arithmetic, without OpenGL.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dreampm/gl/camera.h"

namespace dreampm::gl {

/// Sorts particles by distance into a few hundred layers, the nearest first: what is hidden then
/// fails the depth test before it is shaded. Keeps its memory.
class DepthOrder {
 public:
  /// The indices of all particles whose positions are numbers; within a layer in their own order.
  /// Valid until the next call.
  std::span<const std::uint32_t> front_to_back(std::span<const Vec3f> positions, const Camera& camera);

 private:
  std::vector<std::uint8_t> layer_;
  std::vector<std::uint32_t> order_;
};

}  // namespace dreampm::gl
