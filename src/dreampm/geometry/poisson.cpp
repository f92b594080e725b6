#include "dreampm/geometry/poisson.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "dreampm/base/parallel.h"
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
      : n_(static_cast<int>(std::ceil(side * std::sqrt(3.0)))), width_(n_ + 2 * reach), side_(side), seed_(seed) {
    cells_.assign(static_cast<std::size_t>(width_) * width_ * width_, none);
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
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < n_; ++j)
        for (int k = 0; k < n_; ++k)
          if (const std::int32_t p = cells_[index({i, j, k})]; p != none)
            all.push_back(points_[static_cast<std::size_t>(p)] / side_);
    return all;
  }

 private:
  static constexpr std::int32_t none = -1;
  static constexpr int reach = 2;  ///< cells within which points can be nearer than 1

  double random() { return uniform(seed_, count_++); }
  std::size_t index(const Vec3i& c) const {
    return (static_cast<std::size_t>(c.x + reach) * width_ + static_cast<std::size_t>(c.y + reach)) * width_ +
           static_cast<std::size_t>(c.z + reach);
  }
  /// Adds a point with its images beyond the faces.
  void put(const Vec3i& c, const Vec3d& p) {
    const auto number = static_cast<std::int32_t>(points_.size());
    points_.push_back(p);
    for (int i = c.x - n_; i < n_ + reach; i += n_)
      for (int j = c.y - n_; j < n_ + reach; j += n_)
        for (int k = c.z - n_; k < n_ + reach; k += n_)
          if (i >= -reach && j >= -reach && k >= -reach) cells_[index({i, j, k})] = number;
  }
  double apart(double a, double b) const {
    const double d = std::abs(a - b);
    return std::min(d, side_ - d);
  }

  /// Does test(point) hold for a point that can be within distance 1 of base cell c?
  template <class Test>
  bool any_near(const Vec3i& c, const Test& test) const {
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j) {
        const std::int32_t* const row = cells_.data() + index({c.x + i, c.y + j, c.z});
        for (int k = -reach; k <= reach; ++k)
          if (row[k] != none && test(points_[static_cast<std::size_t>(row[k])])) return true;
      }
    return false;
  }

  void throw_darts(const std::vector<Vec3i>& active, int split) {
    const double edge = side_ / n_ / split;
    const auto darts = static_cast<std::size_t>(std::ceil(darts_per_cell * static_cast<double>(active.size())));
    for (std::size_t d = 0; d < darts; ++d) {
      const Vec3i& cell = active[static_cast<std::size_t>(random() * static_cast<double>(active.size()))];
      const Vec3i base{cell.x / split, cell.y / split, cell.z / split};
      const double x = random(), y = random(), z = random();
      if (cells_[index(base)] != none) continue;
      const Vec3d dart{(cell.x + x) * edge, (cell.y + y) * edge, (cell.z + z) * edge};
      const bool hit = any_near(base, [&](const Vec3d& p) {
        return length2(Vec3d{apart(p.x, dart.x), apart(p.y, dart.y), apart(p.z, dart.z)}) < 1;
      });
      if (!hit) put(base, dart);
    }
  }

  /// The eighths of the active cells that no single point covers.
  std::vector<Vec3i> remaining(const std::vector<Vec3i>& active, int split) const {
    constexpr std::size_t some = 4096;
    std::vector<std::vector<Vec3i>> parts((active.size() + some - 1) / some);
    parallel_for(parts.size(), 1, [&](std::size_t part) {
      const auto begin = active.begin() + static_cast<std::ptrdiff_t>(part * some);
      add_remaining({begin, std::min(begin + some, active.end())}, split, parts[part]);
    });
    std::vector<Vec3i> next;
    for (const std::vector<Vec3i>& part : parts) next.insert(next.end(), part.begin(), part.end());
    return next;
  }
  void add_remaining(std::span<const Vec3i> active, int split, std::vector<Vec3i>& next) const {
    std::vector<Vec3d> near;
    Vec3i near_to{-1, -1, -1};  // cells of one base cell follow one another
    const double edge = side_ / n_ / (2 * split), h = edge / 2;
    for (const Vec3i& cell : active) {
      const Vec3i base{cell.x / split, cell.y / split, cell.z / split};
      if (cells_[index(base)] != none) continue;
      if (!(base == near_to)) {
        near.clear();
        any_near(base, [&](const Vec3d& p) { return near.push_back(p), false; });
        near_to = base;
      }
      unsigned covered = 0;  // a bit for each eighth
      for (std::size_t n = 0; n < near.size() && covered != 0xff; ++n) {
        double far2[3][2];  // along each axis, to the farthest corner of either half
        for (int a = 0; a < 3; ++a)
          for (int half = 0; half < 2; ++half) {
            const double far = apart(near[n][a], (2 * cell[a] + half + 0.5) * edge) + h;
            far2[a][half] = far * far;
          }
        unsigned by_this = 0;
        for (unsigned part = 0; part < 8; ++part)
          by_this |= static_cast<unsigned>(far2[0][part >> 2] + far2[1][part >> 1 & 1] + far2[2][part & 1] < 1) << part;
        covered |= by_this;
        // A point that covers a cell mostly covers the next one too.
        if (by_this != 0) std::swap(near[n], near[n / 2]);
      }
      for (int part = 0; part < 8; ++part)
        if (!(covered >> part & 1))
          next.push_back({2 * cell.x + (part >> 2), 2 * cell.y + (part >> 1 & 1), 2 * cell.z + (part & 1)});
    }
  }

  int n_, width_;
  double side_;
  std::uint64_t seed_, count_ = 0;
  std::vector<std::int32_t> cells_;  ///< the number of its point, and as many beyond each face as can matter
  std::vector<Vec3d> points_;
};

}  // namespace

PoissonTile poisson_tile(int side, std::uint64_t seed) {
  const double in_distances = side / std::cbrt(saturation);
  Board board(in_distances, seed);
  board.fill();
  return {board.points(), 1 / in_distances};
}

}  // namespace dreampm
