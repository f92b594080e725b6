#include "dreampm/play/tools/wall_face.h"

#include <cmath>
#include <limits>
#include <utility>

namespace dreampm::play {
namespace {

/// Of 1: rays that are nearly along a line say nothing of a place on it.
constexpr double along = 0.995;

Side side_of(int axis, bool high) { return static_cast<Side>(2 * axis + (high ? 1 : 0)); }

}  // namespace

std::optional<WallFace> pick_wall(const Box3d& room, const gl::Ray& ray) {
  const auto from = static_cast<Vec3d>(ray.origin), way = static_cast<Vec3d>(ray.direction);
  double enters = 0, leaves = std::numeric_limits<double>::infinity();
  std::optional<Side> before, behind;
  for (int a = 0; a < 3; ++a) {
    if (way[a] == 0) {
      if (from[a] < room.min[a] || from[a] > room.max[a]) return std::nullopt;
      continue;
    }
    double low = (room.min[a] - from[a]) / way[a], high = (room.max[a] - from[a]) / way[a];
    const bool rises = way[a] > 0;
    if (!rises) std::swap(low, high);
    if (low > enters) enters = low, before = side_of(a, !rises);
    if (high < leaves) leaves = high, behind = side_of(a, rises);
  }
  if (!behind || !(leaves > enters)) return std::nullopt;
  if (*behind == Side::y_min && before) return WallFace{*before, from + way * enters};
  return WallFace{*behind, from + way * leaves};
}

std::optional<double> drawn_to(Side side, const Vec3d& from, const gl::Ray& ray) {
  const int axis = static_cast<int>(side) / 2;
  const auto way = static_cast<Vec3d>(ray.direction);
  const double cosine = way[axis];
  if (std::abs(cosine) > along) return std::nullopt;
  const Vec3d off = from - static_cast<Vec3d>(ray.origin);
  return from[axis] + (cosine * dot(way, off) - off[axis]) / (1 - cosine * cosine);
}

}  // namespace dreampm::play
