#include "dreampm/geometry/hollow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/cell_fraction.h"

namespace dreampm {
namespace {

/// A box of numbers, x fastest; what lies outside reads as 0.
template <class T>
class Box {
 public:
  explicit Box(const Vec3i& count)
      : count_(count),
        values_(static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) *
                static_cast<std::size_t>(count.z)) {}
  const Vec3i& count() const { return count_; }
  std::size_t size() const { return values_.size(); }
  bool contains(const Vec3i& c) const {
    return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < count_.x && c.y < count_.y && c.z < count_.z;
  }
  std::size_t index(const Vec3i& c) const {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(count_.x) *
               (static_cast<std::size_t>(c.y) + static_cast<std::size_t>(count_.y) * static_cast<std::size_t>(c.z));
  }
  Vec3i place(std::size_t i) const {
    const auto nx = static_cast<std::size_t>(count_.x), ny = static_cast<std::size_t>(count_.y);
    return {static_cast<int>(i % nx), static_cast<int>(i / nx % ny), static_cast<int>(i / nx / ny)};
  }
  T at(const Vec3i& c) const { return contains(c) ? values_[index(c)] : T{}; }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  Vec3i count_;
  std::vector<T> values_;
};

using Marks = Box<std::uint8_t>;

constexpr std::array<Vec3i, 6> sides{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

/// The half cells of a ball of two cells about a corner, as steps from the one above the corner: of
/// 4 x 4 x 4 those whose middles lie within the ball.
std::vector<Vec3i> ball_of_two_cells() {
  std::vector<Vec3i> steps;
  for (int z = -2; z < 2; ++z)
    for (int y = -2; y < 2; ++y)
      for (int x = -2; x < 2; ++x)
        if (length2(Vec3d{x + 0.5, y + 0.5, z + 0.5}) < 4) steps.push_back({x, y, z});
  return steps;
}

/// Marks the half cells that the ball sweeps from the starting corners on, inside all the way.
Marks swept(const Marks& inside, const std::vector<std::uint8_t>& starts) {
  const std::vector<Vec3i> ball = ball_of_two_cells();
  Marks corners(inside.count());  // by the half cell above each
  parallel_for(corners.size(), 4096, [&](std::size_t i) {
    const Vec3i c = corners.place(i);
    corners[i] = std::all_of(ball.begin(), ball.end(), [&](const Vec3i& step) { return inside.at(c + step); });
  });
  std::vector<std::size_t> front;
  const auto reach = [&](std::size_t i) {
    corners[i] = 2;
    front.push_back(i);
  };
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (starts[i] && corners[i] == 1) reach(i);
  Marks out(inside.count());
  while (!front.empty()) {
    const Vec3i c = corners.place(front.back());
    front.pop_back();
    for (const Vec3i& step : ball) out[out.index(c + step)] = 1;
    for (const Vec3i& side : sides)
      if (corners.at(c + side) == 1) reach(corners.index(c + side));
  }
  return out;
}

/// Adds the half cells beside marked ones, corners too, that have some of the hollow. Balls miss
/// corners.
Marks spread(const Marks& marks, const Box<float>& share, float least) {
  Marks out(marks.count());
  parallel_for(out.size(), 4096, [&](std::size_t i) {
    if (marks[i] || !(share[i] >= least) || share[i] == 0) {
      out[i] = marks[i];
      return;
    }
    const Vec3i c = out.place(i);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (marks.at(c + Vec3i{x, y, z})) out[i] = 1;
  });
  return out;
}

/// The part of a cube of side `h` [m] that lies inside of what `distance` says [m], which is flat
/// over each of its eighths: edges and corners need them.
template <class Distance>
double share_of(const Distance& distance, const Vec3d& p, double h) {
  const double d = distance(p) / h;
  if (d < -0.9) return 1;  // half the diagonal is 0.87
  if (d > 0.9) return 0;
  const double part = 0.5 * h, e = 0.05 * part;
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const Vec3d q = p + Vec3d{(k & 1) - 0.5, (k >> 1 & 1) - 0.5, (k >> 2) - 0.5} * part;
    const Vec3d slope{distance(q + Vec3d{e, 0, 0}) - distance(q - Vec3d{e, 0, 0}),
                      distance(q + Vec3d{0, e, 0}) - distance(q - Vec3d{0, e, 0}),
                      distance(q + Vec3d{0, 0, e}) - distance(q - Vec3d{0, 0, e})};
    sum += cell_fraction(distance(q) / part, length2(slope) > 0 ? normalized(slope) : Vec3d{0, 1, 0});
  }
  return sum / 8;
}

Vec3i cell_at(const HollowCells& h, const Vec3d& p) {
  const Vec3d q = (p - h.low) / h.dx;
  return {static_cast<int>(std::floor(q.x)), static_cast<int>(std::floor(q.y)), static_cast<int>(std::floor(q.z))};
}

/// A grid of cells about a hollow.
HollowCells grid_about(const PlacedHollow& hollow, double dx, const Vec3d& up) {
  if (!(dx > 0) || !std::isfinite(dx)) fail_input("a cell of {} m: a length above 0 is wanted", dx);
  HollowCells out;
  out.region = hollow.region;
  out.dx = dx, out.up = up;
  const Box3d bounds = hollow.region->bounds();
  constexpr int margin = 3;  // cells, in which a ball has room before the mouth
  double cells = 1;
  for (int a = 0; a < 3; ++a) cells *= std::ceil(bounds.size()[a] / dx) + 2 * margin;
  constexpr double most = 0x1p26;  // whose half cells take some 4 GiB
  if (!(cells < most))
    fail_input(
        "a hollow of {:.3g} cells of {:.3g} m is too large to be looked at: {:.3g} are the most; take a larger "
        "space.spacing",
        cells, dx, most);
  for (int a = 0; a < 3; ++a) out.count[a] = static_cast<int>(std::ceil(bounds.size()[a] / dx - 1e-9)) + 2 * margin;
  out.low = bounds.center() - static_cast<Vec3d>(out.count) * (0.5 * dx);
  return out;
}

/// The half cells of a hollow's grid.
class HalfCells {
 public:
  HalfCells(const PlacedHollow& hollow, const HollowCells& cells,
            std::span<const std::shared_ptr<const Region>> blocking)
      : hollow_(hollow),
        blocking_(blocking),
        low_(cells.low),
        up_(cells.up),
        h_(0.5 * cells.dx),
        share_(cells.count * 2),
        inside_(cells.count * 2) {
    parallel_for(share_.size(), 1024, [&](std::size_t i) {
      const Vec3d p = middle(share_.place(i));
      share_[i] = static_cast<float>(share_of([this](const Vec3d& x) { return distance(x); }, p, h_));
      // Before the mouth the way is as wide as the mouth.
      const double depth = below_mouth(p);
      inside_[i] = depth > 0 ? share_[i] >= 0.5f : distance(p + hollow_.normal * (depth - 0.01 * h_)) < 0;
    });
  }

  /// m^3 of all of the hollow.
  double volume() const {
    double sum = 0;
    for (std::size_t i = 0; i < share_.size(); ++i) sum += share_[i] * h_ * h_ * h_;
    return sum;
  }
  /// m along `up`: where the mouth is lowest.
  double spill() const {
    double level = dot(hollow_.mouth, up_);
    if (dot(hollow_.normal, up_) > 1 - 1e-9) return level;
    for (std::size_t i = 0; i < share_.size(); ++i) {
      const Vec3d p = middle(share_.place(i));
      const double depth = below_mouth(p);
      if (inside_[i] && depth > 0 && depth < h_) level = std::min(level, dot(p + hollow_.normal * depth, up_));
    }
    return level;
  }
  /// Returns the cells that liquid reaches through the mouth.
  Marks reached() const {
    std::vector<std::uint8_t> starts(share_.size());  // wholly before the mouth
    for (std::size_t i = 0; i < share_.size(); ++i)
      starts[i] = below_mouth(low_ + static_cast<Vec3d>(share_.place(i)) * h_) < -2 * h_;
    return spread(spread(swept(inside_, starts), share_, 0.5f), share_, 0);
  }
  /// Adds up what cells hold of half cells that are reached, below the spill level of `out`.
  void add_capacity(const Marks& reached, HollowCells& out) const {
    const std::size_t all = static_cast<std::size_t>(out.count.x) * static_cast<std::size_t>(out.count.y) *
                            static_cast<std::size_t>(out.count.z);
    out.capacity.resize(all), out.open.resize(all);
    for (std::size_t i = 0; i < share_.size(); ++i) {
      if (!reached[i]) continue;
      const Vec3i c = share_.place(i);
      const Vec3d p = middle(c);
      const double over = dot(p, up_) - out.spill;
      const double part = over < -0.9 * h_ ? share_[i] : std::min<double>(share_[i], cell_fraction(over / h_, up_));
      const std::size_t cell = out.index({c.x / 2, c.y / 2, c.z / 2});
      out.capacity[cell] += static_cast<float>(part * h_ * h_ * h_);
      if (below_mouth(p) < h_ || over > -h_) out.open[cell] = 1;
    }
    for (const float c : out.capacity) out.reachable += c;
  }

 private:
  Vec3d middle(const Vec3i& c) const { return low_ + (static_cast<Vec3d>(c) + Vec3d{0.5, 0.5, 0.5}) * h_; }
  double distance(const Vec3d& p) const {
    double d = hollow_.region->distance(p);
    for (const auto& solid : blocking_) d = std::max(d, -solid->distance(p));
    return d;
  }
  double below_mouth(const Vec3d& p) const { return dot(hollow_.mouth - p, hollow_.normal); }

  const PlacedHollow& hollow_;
  std::span<const std::shared_ptr<const Region>> blocking_;
  Vec3d low_, up_;
  double h_;          ///< m, side of a half cell
  Box<float> share_;  ///< of each that is hollow
  Marks inside_;      ///< where a ball may be
};

/// Adds what the particles of liquids fill of cells; of those outside to `leaked`.
Box<float> liquid_in(const HollowCells& hollow, std::span<const Vec3d> points, double volume, double& leaked) {
  Box<float> liquid(hollow.count);
  for (const Vec3d& p : points) {
    if (dot(p, hollow.up) > hollow.spill) continue;
    if (hollow.region->distance(p) > 0.5 * hollow.dx) {
      leaked += volume;
    } else if (const Vec3i c = cell_at(hollow, p); liquid.contains(c)) {
      liquid[liquid.index(c)] += static_cast<float>(volume);
    }
  }
  return liquid;
}

/// True if a cell is filled; a cell that a wall cuts goes by those around it too.
bool is_filled(const HollowCells& hollow, const Box<float>& liquid, std::size_t cell) {
  constexpr double whole = 0.9;
  double has = liquid[cell], holds = hollow.capacity[cell];
  if (holds < whole * (hollow.dx * hollow.dx * hollow.dx)) {
    const Vec3i c = liquid.place(cell);
    has = holds = 0;
    for (int k = 0; k < 27; ++k) {
      const Vec3i n = c + Vec3i{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      if (!liquid.contains(n)) continue;
      has += liquid[liquid.index(n)], holds += hollow.capacity[liquid.index(n)];
    }
  }
  return has >= 0.5 * holds;
}

/// Sets of `empty` cells, joined by faces, that are closed in and not too small.
std::vector<Pocket> pockets_of(const HollowCells& hollow, Marks empty) {
  constexpr double least = 4;
  std::vector<Pocket> pockets;
  for (std::size_t first = 0; first < empty.size(); ++first) {
    if (empty[first] != 1) continue;
    std::vector<std::size_t> set{first};
    empty[first] = 2;
    Pocket pocket;
    bool open = false;
    for (std::size_t k = 0; k < set.size(); ++k) {
      const Vec3i c = empty.place(set[k]);
      const double room = hollow.capacity[set[k]];
      pocket.volume += room;
      pocket.at += (hollow.low + (static_cast<Vec3d>(c) + Vec3d{0.5, 0.5, 0.5}) * hollow.dx) * room;
      open = open || hollow.open[set[k]];
      for (const Vec3i& side : sides)
        if (empty.at(c + side) == 1) {
          empty[empty.index(c + side)] = 2;
          set.push_back(empty.index(c + side));
        }
    }
    if (open || pocket.volume < least * (hollow.dx * hollow.dx * hollow.dx)) continue;
    pocket.at = pocket.at / pocket.volume;
    pockets.push_back(pocket);
  }
  std::sort(pockets.begin(), pockets.end(), [](const Pocket& a, const Pocket& b) {
    return std::tie(b.volume, a.at.y, a.at.x, a.at.z) < std::tie(a.volume, b.at.y, b.at.x, b.at.z);
  });
  return pockets;
}

}  // namespace

HollowCells hollow_cells(const PlacedHollow& hollow, double dx, const Vec3d& up,
                         std::span<const std::shared_ptr<const Region>> blocking) {
  HollowCells out = grid_about(hollow, dx, up);
  const HalfCells halves(hollow, out, blocking);
  out.volume = halves.volume();
  out.spill = halves.spill();
  halves.add_capacity(halves.reached(), out);
  return out;
}

Fill fill_of(const HollowCells& hollow, std::span<const Vec3d> points, double volume) {
  Fill out;
  const Box<float> liquid = liquid_in(hollow, points, volume, out.leaked);
  Marks empty(hollow.count);
  for (std::size_t i = 0; i < empty.size(); ++i) {
    if (hollow.capacity[i] == 0) continue;
    if (is_filled(hollow, liquid, i))
      out.filled += hollow.capacity[i];
    else
      empty[i] = 1;
  }
  out.pockets = pockets_of(hollow, std::move(empty));
  return out;
}

}  // namespace dreampm
