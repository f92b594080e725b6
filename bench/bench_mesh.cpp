#include "bench/bench_mesh.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace dreampm {

TriMesh lobed_ball(const Vec3d& middle, double radius, int faces) {
  // The first and the last of n rows of n quads are triangles.
  const auto rows = static_cast<std::uint32_t>(std::lround(0.5 * (1 + std::sqrt(1.0 + 2 * faces)))), columns = rows;
  TriMesh mesh;
  const auto add = [&](std::uint32_t i, std::uint32_t j) {
    const double theta = std::numbers::pi * i / rows, phi = 2 * std::numbers::pi * j / columns;
    const double r = radius * (1 + 0.2 * std::sin(theta) * std::cos(3 * phi)) / 1.2;
    mesh.vertices.push_back(static_cast<Vec3f>(
        middle + Vec3d{std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)} * r));
  };
  add(0, 0);
  for (std::uint32_t i = 1; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) add(i, j);
  add(rows, 0);
  const std::uint32_t last = static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return i == 0 ? 0 : i == rows ? last : 1 + (i - 1) * columns + j % columns;
  };
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rows) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  return mesh;
}

}  // namespace dreampm
