// Polygons and circles of the meshes of solids.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// A polygon with vertices of its own: flat. Counter-clockwise seen from outside.
inline void add_polygon(TriMesh& mesh, const std::vector<Vec3d>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& c : corners) mesh.vertices.push_back(static_cast<Vec3f>(c));
  for (std::uint32_t k = 2; k < corners.size(); ++k) mesh.triangles.push_back({first, first + k - 1, first + k});
}

/// Sides of a circle.
inline constexpr std::uint32_t around = 96;

/// Point `i` of a level circle of radius 1 about the origin.
inline Vec3d on_circle(std::uint32_t i) {
  const double a = 2 * std::numbers::pi * (i % around) / around;
  return {std::cos(a), 0, -std::sin(a)};
}

}  // namespace dreampm
