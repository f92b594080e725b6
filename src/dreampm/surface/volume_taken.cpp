#include "dreampm/surface/volume_taken.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/brick_grid.h"
#include "dreampm/math/bspline.h"
#include "dreampm/physics/shift.h"

namespace dreampm {
namespace {

/// Cells of two spacings, eight particles each at rest. Between two walls there is a whole number
/// of them.
struct Axis {
  double origin = 0, per_cell = 1;  ///< m; cells a meter
  int cells = 0;                    ///< from the low wall to the high one, if there is a high one
  bool low = false, high = false;   ///< walls

  Axis(double from, double to, bool low_wall, bool high_wall, double width) : low(low_wall), high(high_wall) {
    origin = low ? from : high ? to : 0;
    if (low && high) {
      cells = std::max(1, static_cast<int>(std::lround((to - from) / width)));
      width = (to - from) / cells;
    }
    per_cell = 1 / width;
  }
  /// A node beyond a wall is the image of one on this side: nodes lie amid cells.
  int fold(int node) const {
    if (low && node < 0) node = -1 - node;
    if (high && node >= cells) node = 2 * cells - 1 - node;
    return node;
  }
};

/// Three nodes along each axis and their weights.
struct Nodes {
  int node[3][3];
  double weight[3][3], offset[3];  ///< offset: from the middle node [cells]
};

class Reading {
 public:
  explicit Reading(const SurfaceInput& in)
      : in_(in), axes_{axis(0), axis(1), axis(2)}, full_(1.0 / in.spacing / in.spacing / in.spacing) {
    for (const Axis& a : axes_) full_ /= a.per_cell;
    Vec3i low{1 << 30, 1 << 30, 1 << 30}, high{-(1 << 30), -(1 << 30), -(1 << 30)};
    for (const Vec3f& p : in.positions) {
      if (!(std::abs(p.x) < 1e9f && std::abs(p.y) < 1e9f && std::abs(p.z) < 1e9f))
        fail_run("a particle's position is not finite");
      const Nodes s = nodes_of(p);
      for (int a = 0; a < 3; ++a)
        for (const int node : s.node[a]) low[a] = std::min(low[a], node >> 3), high[a] = std::max(high[a], node >> 3);
    }
    if (in.positions.empty()) return;
    grid_ = BrickGrid(low, high, 0);
    // One after the other: sums of floats hang on their order.
    for (const Vec3f& p : in.positions) scatter(nodes_of(p));
  }

  /// Returns the volume that a particle takes, over its volume at rest.
  double taken(const Vec3f& p) const {
    const Nodes s = nodes_of(p);
    // Sums along z, then along y and x: of values, of values weighed by the distance, and of second
    // differences.
    struct Sums {
      double value = 0, slope = 0, bend = 0;
      void add(double w, double distance, double second, double v) {
        value += w * v, slope += w * distance * v, bend += second * v;
      }
    };
    constexpr double second[3] = {1, -2, 1};
    Sums x, y, z;  // each along its axis, weighed along the others
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double m = static_cast<double>(grid_.at(s.node[0][i], s.node[1][j], s.node[2][k]));
          const double wx = s.weight[0][i], wy = s.weight[1][j], wz = s.weight[2][k];
          const auto distance = [&](int a, std::size_t n) { return static_cast<double>(n) - 1 - s.offset[a]; };
          x.add(wx, distance(0, i), second[i], wy * wz * m);
          y.add(wy, distance(1, j), second[j], wx * wz * m);
          z.add(wz, distance(2, k), second[k], wx * wy * m);
        }
      }
    }
    const double slope = 4 * std::sqrt(x.slope * x.slope + y.slope * y.slope + z.slope * z.slope);
    const double curvature = -(x.bend + y.bend + z.bend) / x.value;
    const double volume = reading_at_rest_density(slope / x.value, curvature) * full_ / x.value;
    // In sheets and drops nothing is known below this.
    return curvature > 0.6 ? std::max(volume, 1.0) : volume;
  }

 private:
  Axis axis(std::size_t a) const {
    const auto i = static_cast<int>(a);
    return {static_cast<double>(in_.walls.min[i]), static_cast<double>(in_.walls.max[i]), in_.is_wall[2 * a],
            in_.is_wall[2 * a + 1], 2 * static_cast<double>(in_.spacing)};
  }
  Nodes nodes_of(const Vec3f& p) const {
    Nodes s;
    for (int a = 0; a < 3; ++a) {
      const Axis& axis = axes_[static_cast<std::size_t>(a)];
      const double u = (static_cast<double>(p[a]) - axis.origin) * axis.per_cell - 0.5, middle = std::floor(u + 0.5);
      s.offset[a] = u - middle;
      const auto w = bspline2(s.offset[a]);
      for (int n = 0; n < 3; ++n) {
        s.node[a][n] = axis.fold(static_cast<int>(middle) - 1 + n);
        s.weight[a][n] = w.w[n];
      }
    }
    return s;
  }
  void scatter(const Nodes& s) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3i n{s.node[0][i], s.node[1][j], s.node[2][k]};
          const std::size_t at = grid_.slot_index({n.x >> 3, n.y >> 3, n.z >> 3});
          const std::int32_t slot = grid_.slot(at);
          auto& brick = slot >= 0 ? grid_.values()[static_cast<std::size_t>(slot)] : grid_.open(at, 0);
          brick[BrickGrid::offset(n.x, n.y, n.z)] +=
              static_cast<float>(s.weight[0][i] * s.weight[1][j] * s.weight[2][k]);
        }
  }

  const SurfaceInput& in_;
  std::array<Axis, 3> axes_;
  double full_;  ///< particles of a full cell
  BrickGrid grid_;
};

}  // namespace

double volume_taken(const SurfaceInput& input) {
  constexpr std::size_t kernel = 216;  // particles that fill its 27 cells
  const Reading reading(input);
  const std::size_t n = input.positions.size();
  const double sum =
      n < kernel
          ? static_cast<double>(n)
          : parallel_reduce(n, 0.0, [&](double& all, std::size_t i) { all += reading.taken(input.positions[i]); });
  const auto h = static_cast<double>(input.spacing);
  return sum * h * h * h;
}

}  // namespace dreampm
