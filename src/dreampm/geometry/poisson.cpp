#include "dreampm/geometry/poisson.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/rng.h"

namespace dreampm {
namespace {

/// Points of a maximal sample per cube of the least distance: saturated random sequential addition
/// packs 38.4 % of space with balls of that diameter (Torquato, Uche, Stillinger 2006).
constexpr double saturation = 0.3841 * 6 / 3.14159265358979323846;
constexpr double darts_per_cell = 0.3;  // a round; Ebeida et al. find 0.3 to 0.6 best in 3D
/// Cells halve each round; what is left after this many is narrower than a millionth of the
/// distance.
constexpr int most_rounds = 20;

/// The darts in units of the distance. A cell of the base grid has diagonal 1, so it holds one
/// point at most.
class Board {
 public:
  Board(double side, std::uint64_t seed)
      : n_(static_cast<int>(std::ceil(side * std::sqrt(3.0)))), side_(side), seed_(seed) {
    points_.assign(static_cast<std::size_t>(n_) * n_ * n_, {-1, 0, 0});
  }

  void fill() {
    std::vector<Vec3i> active;
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j)
        for (int k = 0; k < n_; ++k) active.push_back({i, j, k});
    int split = 1;  // cells to a base cell's edge
    for (int round = 0; round < most_rounds && !active.empty(); ++round, split *= 2) {
      throw_darts(active, split);
      active = remaining(active, split);
    }
  }

  std::vector<Vec3d> points() const {
    std::vector<Vec3d> all;
    for (const Vec3d& p : points_)
      if (p.x >= 0) all.push_back(p / side_);
    return all;
  }

 private:
  double random() { return uniform(seed_, count_++); }
  int wrap(int i) const { return i < 0 ? i + n_ : i >= n_ ? i - n_ : i; }
  Vec3d& at(int i, int j, int k) {
    return points_[(static_cast<std::size_t>(wrap(i)) * n_ + static_cast<std::size_t>(wrap(j))) * n_ +
                   static_cast<std::size_t>(wrap(k))];
  }
  double apart(double a, double b) const {
    const double d = std::abs(a - b);
    return std::min(d, side_ - d);
  }

  /// Does test(point) hold for a point that can be within distance 1 of base cell c?
  template <class Test>
  bool any_near(const Vec3i& c, const Test& test) {
    for (int i = c.x - 2; i <= c.x + 2; ++i)
      for (int j = c.y - 2; j <= c.y + 2; ++j)
        for (int k = c.z - 2; k <= c.z + 2; ++k)
          if (const Vec3d& p = at(i, j, k); p.x >= 0 && test(p)) return true;
    return false;
  }

  void throw_darts(const std::vector<Vec3i>& active, int split) {
    const double edge = side_ / n_ / split;
    const auto darts = static_cast<std::size_t>(std::ceil(darts_per_cell * static_cast<double>(active.size())));
    for (std::size_t d = 0; d < darts; ++d) {
      const Vec3i& cell = active[static_cast<std::size_t>(random() * static_cast<double>(active.size()))];
      const Vec3i base{cell.x / split, cell.y / split, cell.z / split};
      const double x = random(), y = random(), z = random();
      const Vec3d dart{(cell.x + x) * edge, (cell.y + y) * edge, (cell.z + z) * edge};
      Vec3d& home = at(base.x, base.y, base.z);
      if (home.x >= 0) continue;
      const bool hit = any_near(base, [&](const Vec3d& p) {
        return length2(Vec3d{apart(p.x, dart.x), apart(p.y, dart.y), apart(p.z, dart.z)}) < 1;
      });
      if (!hit) home = dart;
    }
  }

  /// The eighths of the active cells that no single point covers.
  std::vector<Vec3i> remaining(const std::vector<Vec3i>& active, int split) {
    std::vector<Vec3i> next;
    std::vector<Vec3d> near;
    const double edge = side_ / n_ / (2 * split);
    for (const Vec3i& cell : active) {
      const Vec3i base{cell.x / split, cell.y / split, cell.z / split};
      if (at(base.x, base.y, base.z).x >= 0) continue;
      near.clear();
      any_near(base, [&](const Vec3d& p) { return near.push_back(p), false; });
      for (int part = 0; part < 8; ++part) {
        const Vec3i small{2 * cell.x + (part >> 2), 2 * cell.y + (part >> 1 & 1), 2 * cell.z + (part & 1)};
        const Vec3d center{(small.x + 0.5) * edge, (small.y + 0.5) * edge, (small.z + 0.5) * edge};
        const double h = edge / 2;  // to the farthest corner
        const bool covered = std::any_of(near.begin(), near.end(), [&](const Vec3d& p) {
          return length2(Vec3d{apart(p.x, center.x) + h, apart(p.y, center.y) + h, apart(p.z, center.z) + h}) < 1;
        });
        if (!covered) next.push_back(small);
      }
    }
    return next;
  }

  int n_;
  double side_;
  std::uint64_t seed_, count_ = 0;
  std::vector<Vec3d> points_;  ///< one a base cell; x < 0: none
};

}  // namespace

PoissonTile poisson_tile(int side, std::uint64_t seed) {
  const double in_distances = side / std::cbrt(saturation);
  Board board(in_distances, seed);
  board.fill();
  return {board.points(), 1 / in_distances};
}

}  // namespace dreampm
