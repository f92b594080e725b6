// Sums over particles at the middles of cubic cells, by quadratic B-splines, in bricks where there
// are particles. Beyond a wall lies the image of what is before it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/math/bspline.h"
#include "dreampm/math/vec.h"
#include "dreampm/surface/lattice.h"

namespace dreampm::foam {

/// The box that matter is in.
struct Room {
  Box3f box{};                     ///< m
  std::array<bool, 6> is_wall{};   ///< x_min, x_max, y_min, y_max, z_min, z_max
  std::array<bool, 3> periodic{};  ///< axes whose ends meet
  /// No end of a periodic axis is a wall.
  bool wall(int axis, bool high) const {
    return !periodic[static_cast<std::size_t>(axis)] && is_wall[static_cast<std::size_t>(2 * axis + (high ? 1 : 0))];
  }
  /// `p` where a periodic axis has it between its ends.
  Vec3f wrapped(Vec3f p) const;
  /// The shortest way from `a` to `b`.
  Vec3f way(const Vec3f& a, const Vec3f& b) const;
};

/// The nodes along an axis: node i lies amid cell i.
struct NodeAxis {
  float origin = 0, per_cell = 1;  ///< m; cells a meter
  int cells = 0;                   ///< from end to end, where both ends are walls or meet
  bool low = false, high = false;  ///< walls
  bool periodic = false;

  /// Cells of `width` [m], or a little more or less, so that walls lie between cells.
  static NodeAxis over(const Room& room, int axis, float width);
  /// In cells, from node 0.
  float coordinate(float x) const { return (x - origin) * per_cell - 0.5f; }
  float place(int node) const { return origin + (static_cast<float>(node) + 0.5f) / per_cell; }
  /// The node that holds what is at `node`; `sign` turns where that is an image.
  int fold(int node, float& sign) const {
    if (periodic) return node < 0 ? node + cells * ((cells - 1 - node) / cells) : node % cells;
    if (low && node < 0) {
      sign = -sign;
      node = -1 - node;
    }
    if (high && node >= cells) {
      sign = -sign;
      node = 2 * cells - 1 - node;
    }
    return node;
  }
};
using NodeAxes = std::array<NodeAxis, 3>;
NodeAxes node_axes(const Room& room, float width);

/// Particles grouped by bricks of 4^3 cells.
struct BrickOrder {
  BrickOrder(std::span<const Vec3f> points, const NodeAxes& axes);
  std::vector<Vec3i> bricks;         ///< those with particles, in the order of their keys
  std::vector<std::uint32_t> first;  ///< brick b has order[first[b]] .. order[first[b + 1] - 1]
  std::vector<std::uint32_t> order;
};

/// K numbers at each node.
template <int K>
class LatticeField {
 public:
  static constexpr int side = 4, volume = side * side * side;
  using Brick = std::array<std::array<float, volume>, K>;

  explicit LatticeField(const NodeAxes& axes) : axes_(axes) {}

  const NodeAxes& axes() const { return axes_; }
  std::size_t bricks() const { return places_.size(); }
  Brick& brick(std::size_t b) { return values_[b]; }
  const Brick& brick(std::size_t b) const { return values_[b]; }
  /// Of the n-th node of a brick.
  Vec3i node(std::size_t b, int n) const {
    return Vec3i{places_[b].x * side + (n >> 4), places_[b].y * side + (n >> 2 & 3), places_[b].z * side + (n & 3)};
  }
  Vec3f place(const Vec3i& n) const { return {axes_[0].place(n.x), axes_[1].place(n.y), axes_[2].place(n.z)}; }

  /// Adds weight * give(i, sign, from node to particle, numbers) of each particle at its 27 nodes.
  /// `sign` is -1 along the axes in which a node holds the image: vectors are to be turned by it.
  template <class Give>
  void scatter(std::span<const Vec3f> points, const Give& give);

  /// Calls visit(brick, n, sign) for a node, folded; nothing where no particle is near.
  template <class Visit>
  void at(Vec3i node, const Visit& visit) const {
    Vec3f sign{1, 1, 1};
    node = folded(node, sign);
    const std::int32_t b = index_.find(brick_of(node));
    if (b != surface::LatticeMap::kAbsent) visit(values_[static_cast<std::size_t>(b)], offset(node), sign);
  }
  float value(const Vec3i& node, int k) const {
    float v = 0;
    at(node,
       [&](const Brick& b, int n, const Vec3f&) { v = b[static_cast<std::size_t>(k)][static_cast<std::size_t>(n)]; });
    return v;
  }
  /// Calls visit(brick, n, sign, weight) for the eight nodes about p, as trilinear interpolation
  /// weighs them.
  template <class Visit>
  void about(const Vec3f& p, const Visit& visit) const {
    about_with_slope(
        p, [&](const Brick& b, int n, const Vec3f& sign, float weight, const Vec3f&) { visit(b, n, sign, weight); });
  }
  /// The same with the gradient of the weight [1/m].
  template <class Visit>
  void about_with_slope(const Vec3f& p, const Visit& visit) const {
    Vec3i i;
    Vec3f f;
    for (int a = 0; a < 3; ++a) {
      const float c = axes_[static_cast<std::size_t>(a)].coordinate(p[a]), low = std::floor(std::clamp(c, -1e6f, 1e6f));
      i[a] = static_cast<std::int32_t>(low), f[a] = std::clamp(c - low, 0.0f, 1.0f);
    }
    // Most of them lie in one brick, which is looked up once.
    Vec3i in_brick;
    std::int32_t found = surface::LatticeMap::kAbsent;
    for (int corner = 0; corner < 8; ++corner) {
      const int x = corner >> 2, y = corner >> 1 & 1, z = corner & 1;
      const float wx = x ? f.x : 1 - f.x, wy = y ? f.y : 1 - f.y, wz = z ? f.z : 1 - f.z;
      const Vec3f slope{(x ? wy : -wy) * wz * axes_[0].per_cell, (y ? wx : -wx) * wz * axes_[1].per_cell,
                        (z ? wx : -wx) * wy * axes_[2].per_cell};
      Vec3f sign{1, 1, 1};
      const Vec3i node = folded(i + Vec3i{x, y, z}, sign), brick = brick_of(node);
      if (corner == 0 || !(brick == in_brick)) found = index_.find(brick), in_brick = brick;
      if (found != surface::LatticeMap::kAbsent)
        visit(values_[static_cast<std::size_t>(found)], offset(node), sign, wx * wy * wz, slope);
    }
  }

  static int offset(const Vec3i& n) { return (n.x & 3) << 4 | (n.y & 3) << 2 | (n.z & 3); }
  static Vec3i brick_of(const Vec3i& n) { return {n.x >> 2, n.y >> 2, n.z >> 2}; }

 private:
  static constexpr int reach = side + 2;  ///< nodes that the particles of a brick reach, along an axis
  using Arena = std::array<std::array<float, K>, reach * reach * reach>;

  template <class Give>
  void scatter_one(const Vec3f& p, std::uint32_t i, const Vec3i& brick, const Give& give, Arena& to) const;
  Vec3i folded(Vec3i node, Vec3f& sign) const {
    for (int a = 0; a < 3; ++a) node[a] = axes_[static_cast<std::size_t>(a)].fold(node[a], sign[a]);
    return node;
  }
  Vec3i wrapped(Vec3i brick) const {
    for (int a = 0; a < 3; ++a)
      if (const NodeAxis& axis = axes_[static_cast<std::size_t>(a)]; axis.periodic) {
        const int n = axis.cells / side;
        brick[a] = (brick[a] % n + n) % n;
      }
    return brick;
  }
  void open(const BrickOrder& order);

  NodeAxes axes_;
  std::vector<Vec3i> places_;
  surface::LatticeMap index_;
  std::vector<Brick> values_;
};

/// The cell of a point, in the box where there are walls.
inline Vec3i cell_of(const NodeAxes& axes, const Vec3f& p) {
  Vec3i c;
  for (int a = 0; a < 3; ++a) {
    const NodeAxis& axis = axes[static_cast<std::size_t>(a)];
    int n = static_cast<int>(std::floor(std::clamp((p[a] - axis.origin) * axis.per_cell, -1e6f, 1e6f)));
    if (axis.low || axis.periodic) n = std::max(n, 0);
    if (axis.high || axis.periodic) n = std::min(n, axis.cells - 1);
    c[a] = n;
  }
  return c;
}

template <int K>
template <class Give>
void LatticeField<K>::scatter_one(const Vec3f& p, std::uint32_t i, const Vec3i& brick, const Give& give,
                                  Arena& to) const {
  const Vec3i cell = cell_of(axes_, p);
  float weight[3][3], away[3][3], sign[3][3];
  int at[3][3];
  for (int a = 0; a < 3; ++a) {
    const NodeAxis& axis = axes_[static_cast<std::size_t>(a)];
    const float t = std::clamp(axis.coordinate(p[a]) - static_cast<float>(cell[a]), -0.5f, 0.5f);
    const auto w = bspline2(t);
    for (int n = 0; n < 3; ++n) {
      float s = 1;
      const int node = cell[a] - 1 + n, folded = axis.periodic ? node : axis.fold(node, s);
      // To an image the way is that of the image.
      away[a][n] = s * (t - static_cast<float>(n - 1)) / axis.per_cell;
      weight[a][n] = w.w[n], sign[a][n] = s;
      at[a][n] = folded - brick[a] * side + 1;
    }
  }
  std::array<float, K> numbers;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z) {
        give(i, Vec3f{sign[0][x], sign[1][y], sign[2][z]}, Vec3f{away[0][x], away[1][y], away[2][z]}, numbers);
        const float w = weight[0][x] * weight[1][y] * weight[2][z];
        const auto n = static_cast<std::size_t>((at[0][x] * reach + at[1][y]) * reach + at[2][z]);
        for (std::size_t k = 0; k < K; ++k) to[n][k] += w * numbers[k];
      }
}

template <int K>
void LatticeField<K>::open(const BrickOrder& order) {
  std::vector<std::uint64_t> keys;
  surface::LatticeMap seen(order.bricks.size());
  for (const Vec3i& b : order.bricks)
    for (int d = 0; d < 27; ++d) {
      const Vec3i near = wrapped(b + Vec3i{d / 9 - 1, d / 3 % 3 - 1, d % 3 - 1});
      if (seen.insert(near, static_cast<std::int32_t>(keys.size())) == static_cast<std::int32_t>(keys.size()) &&
          seen.size() > keys.size())
        keys.push_back(surface::LatticeMap::key(near));
    }
  std::sort(keys.begin(), keys.end());
  places_.clear(), index_ = surface::LatticeMap(keys.size());
  for (const std::uint64_t key : keys) {
    index_.insert(surface::LatticeMap::place(key), static_cast<std::int32_t>(places_.size()));
    places_.push_back(surface::LatticeMap::place(key));
  }
  values_.assign(places_.size(), Brick{});
}

template <int K>
template <class Give>
void LatticeField<K>::scatter(std::span<const Vec3f> points, const Give& give) {
  const BrickOrder order(points, axes_);
  open(order);
  std::vector<Arena> arenas(order.bricks.size());
  surface::LatticeMap arena_of(order.bricks.size());
  for (std::size_t b = 0; b < order.bricks.size(); ++b) arena_of.insert(order.bricks[b], static_cast<std::int32_t>(b));
  parallel_for(arenas.size(), 4, [&](std::size_t b) {
    for (auto& numbers : arenas[b]) numbers.fill(0);
    for (std::uint32_t i = order.first[b]; i < order.first[b + 1]; ++i)
      scatter_one(points[order.order[i]], order.order[i], order.bricks[b], give, arenas[b]);
  });
  // Each brick takes from the arenas about it, always in one order.
  parallel_for(places_.size(), 16, [&](std::size_t b) {
    for (int d = 0; d < 27; ++d) {
      const Vec3i off{d / 9 - 1, d / 3 % 3 - 1, d % 3 - 1};
      const std::int32_t from = arena_of.find(wrapped(places_[b] + off));
      if (from == surface::LatticeMap::kAbsent) continue;
      const Arena& arena = arenas[static_cast<std::size_t>(from)];
      for (int n = 0; n < volume; ++n) {
        const Vec3i local{(n >> 4) - side * off.x + 1, (n >> 2 & 3) - side * off.y + 1, (n & 3) - side * off.z + 1};
        if (std::min({local.x, local.y, local.z}) < 0 || std::max({local.x, local.y, local.z}) >= reach) continue;
        const auto m = static_cast<std::size_t>((local.x * reach + local.y) * reach + local.z);
        for (std::size_t k = 0; k < K; ++k) values_[b][k][static_cast<std::size_t>(n)] += arena[m][k];
      }
    }
  });
}

}  // namespace dreampm::foam
