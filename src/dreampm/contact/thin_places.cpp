#include "dreampm/contact/thin_places.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/contact/surface_points.h"
#include "dreampm/physics/collider_contact.h"
#include "dreampm/state/grid.h"
#include "dreampm/state/neighbors.h"

namespace dreampm {
namespace {

/// True if the collider ends again less than `thickness` behind a place on its surface.
bool is_thin(const ColliderView& view, const Vec3d& at, const Vec3d& normal, double thickness) {
  constexpr int steps = 8;
  // The deepest place shows how far about it the solid goes: mostly to the surface.
  const double deepest = view.nearest(at - normal * thickness);
  if (deepest > 1e-6) return true;
  for (int k = 1; k < steps && thickness * (steps - k) / steps > -deepest / 1.05; ++k)
    if (view.nearest(at - normal * (thickness * k / steps)) > 1e-6) return true;
  return false;
}

/// True if a surface is not plane within a cell of a place on it: at edges, in corners, where it is
/// round and narrow.
bool is_bent(const ColliderView& view, const Vec3d& at, const Vec3d& normal) {
  const std::array<Vec3d, 8> ways = ways_along(normal);
  return std::any_of(ways.begin(), ways.end(), [&](const Vec3d& way) {
    return std::abs(view.nearest(at + way * ColliderContact::bend_reach)) > ColliderContact::bend;
  });
}

}  // namespace

bool needs_distance(const ColliderView& view, const Vec3d& at, double distance) {
  if (ColliderView::inside(distance) || distance > 1) return false;
  const std::uint16_t collider = view.nearest_collider(at);
  if (view.holds_matter(collider)) return false;
  const Vec3d normal = view.normal(collider, at), foot = at - normal * distance;
  return is_thin(view, foot, normal, ColliderContact::thin_wall) ||
         (is_thin(view, foot, normal, ColliderContact::thin_edge) && is_bent(view, foot, normal));
}

std::uint64_t thin_cells(const ColliderView& view) {
  std::uint64_t cells = 0;
  // By cell, from one before the block's first on: not looked at yet, not needed, needed.
  constexpr int width = block_width + 2;
  std::array<std::int8_t, width * width * width> known{};
  std::array<Vec3d, known.size()> middles;
  std::array<double, known.size()> distances;
  for (int n = 0; n < static_cast<int>(known.size()); ++n)
    middles[static_cast<std::size_t>(n)] =
        static_cast<Vec3d>(Vec3i{n / (width * width) - 1, n / width % width - 1, n % width - 1}) + Vec3d{0.5, 0.5, 0.5};
  view.nearest(middles, distances.data());
  const auto index = [](const Vec3i& cell) {
    return static_cast<std::size_t>(((cell.x + 1) * width + cell.y + 1) * width + cell.z + 1);
  };
  const auto needed_at = [&](const Vec3i& cell) {
    const std::size_t n = index(cell);
    if (known[n] == 0) known[n] = needs_distance(view, middles[n], distances[n]) ? 2 : 1;
    return known[n] == 2;
  };
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3i first = node_offset(n);
    if (std::abs(distances[index(first)]) > thin_places_reach) continue;
    bool needed = false;
    for (int m = 0; m < 27 && !needed; ++m) needed = needed_at(first + neighbor_offset(m));
    cells |= static_cast<std::uint64_t>(needed) << n;
  }
  return cells;
}

std::uint64_t thin_cells(const ColliderView& view, std::uint16_t body, const BodyKernel& kernel) {
  if (!kernel.any_thin()) return 0;
  std::uint64_t cells = 0;
  for (int n = 0; n < block_nodes; ++n) {
    const Vec3d middle = static_cast<Vec3d>(node_offset(n)) + Vec3d{0.5, 0.5, 0.5};
    const bool needed =
        std::abs(view.distance(body, middle)) <= thin_places_reach && kernel.is_thin(view.in_frame(body, middle));
    cells |= static_cast<std::uint64_t>(needed) << n;
  }
  return cells;
}

}  // namespace dreampm
