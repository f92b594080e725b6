#include "dreampm/solver/emission_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/poisson.h"
#include "dreampm/math/rng.h"

namespace dreampm {
namespace {

/// Places in cells of about a spacing, so that those of a thin shape are found without the others.
class EmissionTile {
 public:
  static constexpr int cells = 16;  ///< along each edge

  EmissionTile() {
    constexpr std::uint64_t seed = 53;
    // Other threads may wait for it: no task of another loop may begin on this thread meanwhile.
    PoissonTile tile;
    on_this_thread([&] { tile = poisson_tile(cells, seed); });
    // A spacing^3 for each point.
    edge_ = std::cbrt(static_cast<double>(tile.points.size()));
    const auto cell_of = [](const Vec3d& p) {
      const auto of = [](double x) { return std::min(static_cast<int>(x * cells), cells - 1); };
      return static_cast<std::size_t>(index(of(p.x), of(p.y), of(p.z)));
    };
    for (const Vec3d& p : tile.points) ++start_[cell_of(p) + 1];
    for (std::size_t c = 0; c + 1 < start_.size(); ++c) start_[c + 1] += start_[c];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    points_.resize(tile.points.size());
    for (const Vec3d& p : tile.points) points_[next[cell_of(p)]++] = p * edge_;
  }

  double edge() const { return edge_; }          ///< spacings
  double cell() const { return edge_ / cells; }  ///< spacings
  /// Calls body(place [spacings]) for what lies in that cell of all space.
  template <class Body>
  void for_cell(const std::array<std::int64_t, 3>& at, const Body& body) const {
    Vec3d corner;
    std::array<int, 3> own{};
    for (int a = 0; a < 3; ++a) {
      const std::int64_t tile =
          at[std::size_t(a)] >= 0 ? at[std::size_t(a)] / cells : -((cells - 1 - at[std::size_t(a)]) / cells);
      own[std::size_t(a)] = static_cast<int>(at[std::size_t(a)] - tile * cells);
      corner[a] = static_cast<double>(tile) * edge_;
    }
    const auto c = static_cast<std::size_t>(index(own[0], own[1], own[2]));
    for (std::uint32_t i = start_[c]; i < start_[c + 1]; ++i) body(corner + points_[i]);
  }

 private:
  static int index(int i, int j, int k) { return (i * cells + j) * cells + k; }
  double edge_ = 1;
  std::vector<Vec3d> points_;  ///< spacings
  std::array<std::uint32_t, cells * cells * cells + 1> start_{};
};

const EmissionTile& emission_tile() {
  static const EmissionTile one;
  return one;
}

/// Spacings: what passes through less of the shape than that, at its rim, is not met.
constexpr double finest = 1.0 / 16;

/// The axes of the tiles in (along, across, over): a line along the first one fills the tile
/// evenly, by the ratios of the sequence R2 (Roberts 2018, "The unreasonable effectiveness of
/// quasirandom sequences").
struct Axes {
  Vec3d along, across, over;
};
Axes tile_axes() {
  const Vec3d along = normalized(Vec3d{1, 0.7548776662466927, 0.5698402909980532});
  const Vec3d across = normalized(cross(along, Vec3d{0, 1, 0}));
  return {along, across, cross(along, across)};
}

}  // namespace

EmissionPattern::EmissionPattern(const Region& shape, const Vec3d& along, double spacing, std::uint64_t seed)
    : shape_(shape), spacing_(spacing), along_(along) {
  across_ = normalized(cross(along_, std::abs(along_.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
  over_ = cross(along_, across_);
  const Box3d box = shape.bounds();
  middle_ = box.center();
  const Vec3d size = box.size() * 0.5;
  const auto reach = [&](const Vec3d& axis) {
    return std::abs(axis.x) * size.x + std::abs(axis.y) * size.y + std::abs(axis.z) * size.z;
  };
  half_ = {reach(along_), reach(across_), reach(over_)};
  for (std::uint64_t a = 0; a < 3; ++a) offset_[static_cast<int>(a)] = emission_tile().edge() * uniform(seed, a);
}

double EmissionPattern::area() const {
  const auto parts = [&](double half) {
    return std::max(1, static_cast<int>(std::lround(2 * half / (0.125 * spacing_))));
  };
  const int columns = parts(half_.y), rows = parts(half_.z);
  std::size_t met = 0;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const Vec3d column = middle_ + across_ * (((i + 0.5) * 2 / columns - 1) * half_.y) +
                           over_ * (((j + 0.5) * 2 / rows - 1) * half_.z);
      for (double t = -half_.x, distance = 0; t <= half_.x; t += std::max(distance, finest * spacing_))
        if (distance = shape_.distance(column + along_ * t); distance < 0) {
          ++met;
          break;
        }
    }
  return static_cast<double>(met) * (2 * half_.y / columns) * (2 * half_.z / rows);
}

Vec3d EmissionPattern::place(const Vec3d& own, double moved) const {
  static const Axes axes = tile_axes();
  const Vec3d p = own - offset_;
  return middle_ + along_ * (dot(p, axes.along) * spacing_ + moved) + across_ * (dot(p, axes.across) * spacing_) +
         over_ * (dot(p, axes.over) * spacing_);
}

void EmissionPattern::for_entering(double moved_before, double moved, bool first,
                                   const std::function<void(const Vec3d&)>& body) const {
  static const Axes axes = tile_axes();
  const EmissionTile& places = emission_tile();
  const double cell = places.cell();
  // The shape's box in coordinates of the tiles, and a cell's half diagonal around it.
  const Vec3d middle = offset_ - axes.along * (moved / spacing_);
  const double around = 0.51 * std::sqrt(3.0) * cell;
  const double move = moved - moved_before;
  const Vec3d half = (half_ + Vec3d{move, 0, 0}) / spacing_ + Vec3d{around, around, around};
  const int parts = std::max(1, static_cast<int>(std::ceil(move / (finest * spacing_))));
  // True if a place is in the shape, or came through its rim since.
  const auto came = [&](const Vec3d& own, const Vec3d& p) {
    const double distance = shape_.distance(p);
    if (distance < 0 || first || distance > move) return distance < 0;
    for (int k = 1; k < parts; ++k)
      if (shape_.distance(place(own, moved_before + move * k / parts)) < 0) return true;
    return false;
  };
  Vec3d reach;
  for (int a = 0; a < 3; ++a)
    reach[a] = std::abs(axes.along[a]) * half.x + std::abs(axes.across[a]) * half.y + std::abs(axes.over[a]) * half.z;
  const auto low = [&](int a) { return static_cast<std::int64_t>(std::floor((middle[a] - reach[a]) / cell)); };
  const auto high = [&](int a) { return static_cast<std::int64_t>(std::floor((middle[a] + reach[a]) / cell)); };
  for (std::int64_t i = low(0); i <= high(0); ++i)
    for (std::int64_t j = low(1); j <= high(1); ++j) {
      // The part of this line of cells that is in the box.
      const Vec3d from =
          Vec3d{(static_cast<double>(i) + 0.5) * cell, (static_cast<double>(j) + 0.5) * cell, 0} - middle;
      double begin = middle.z - reach.z, end = middle.z + reach.z;
      for (int a = 0; a < 3; ++a) {
        const Vec3d& axis = a == 0 ? axes.along : a == 1 ? axes.across : axes.over;
        const double at = dot(from, axis), slope = axis.z;  // |at + slope z| <= half
        if (std::abs(slope) < 1e-9) continue;
        const double s = (-half[a] - at) / slope, t = (half[a] - at) / slope;
        begin = std::max(begin, std::min(s, t)), end = std::min(end, std::max(s, t));
      }
      const auto first_cell = static_cast<std::int64_t>(std::floor(begin / cell - 0.5)),
                 last_cell = static_cast<std::int64_t>(std::ceil(end / cell - 0.5));
      for (std::int64_t k = first_cell; k <= last_cell; ++k)
        places.for_cell({i, j, k}, [&](const Vec3d& own) {
          const Vec3d p = place(own, moved);
          if (!came(own, p)) return;
          if (first || !(shape_.distance(place(own, moved_before)) < 0)) body(p);
        });
    }
}

}  // namespace dreampm
