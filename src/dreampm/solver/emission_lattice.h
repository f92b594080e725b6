// The lattice on which an emitter gives particles.
#pragma once
#include <algorithm>
#include <cmath>

#include "dreampm/geometry/region.h"

namespace dreampm {

/// Columns of sites along a direction, `spacing` [m] apart along it and across, that move along it
/// through a shape. Each column has a phase of its own: of columns in step whole layers would come
/// in at once, and a jet that falls would tear into them. The shape must outlive the lattice.
class EmissionLattice {
 public:
  /// `along`: a unit vector.
  EmissionLattice(const Region& shape, const Vec3d& along, double spacing)
      : shape_(shape), spacing_(spacing), along_(along) {
    across_ = normalized(cross(along_, std::abs(along_.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
    over_ = cross(along_, across_);
    const Box3d box = shape.bounds();
    middle_ = box.center();
    const Vec3d half = box.size() * 0.5;
    const auto reach = [&](const Vec3d& axis) {
      return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
    };
    depth_ = reach(along_);
    columns_ = static_cast<int>(std::ceil(reach(across_) / spacing));
    rows_ = static_cast<int>(std::ceil(reach(over_) / spacing));
  }

  /// The area that its columns fill of the shape's section, as seen along it [m^2]: matter that
  /// moves at u comes in at u times this.
  double area() const {
    std::size_t met = 0;
    for_columns([&](int i, int j) {
      for (double t = -depth_; t <= depth_; t += 0.25 * spacing_)
        if (inside(i, j, t)) {
          ++met;
          break;
        }
    });
    return static_cast<double>(met) * spacing_ * spacing_;
  }

  /// Calls body(place) for each site that is in the shape when the lattice has moved `moved` [m],
  /// and was not when it had moved `moved_before`; for all that are in the shape, if `first`. Where
  /// it was is computed as where it is, so that no site on the rim of the shape is missed between
  /// two calls by rounding.
  template <class Body>
  void for_entering(double moved_before, double moved, bool first, const Body& body) const {
    const int low = static_cast<int>(std::ceil((-depth_ - moved) / spacing_ - 1)),
              high = static_cast<int>(std::floor((depth_ - moved) / spacing_ + 1));
    for (int k = low; k <= high; ++k)
      for_columns([&](int i, int j) {
        const double own = (k + phase(i, j)) * spacing_;
        if (!inside(i, j, own + moved)) return;
        if (first || !inside(i, j, own + moved_before)) body(site(i, j, own + moved));
      });
  }

 private:
  template <class Body>
  void for_columns(const Body& body) const {
    for (int i = -columns_; i < columns_; ++i)
      for (int j = -rows_; j < rows_; ++j) body(i, j);
  }
  /// In [0, 1): of neighbors far apart, by the sequence R2 (Roberts 2018, "The unreasonable
  /// effectiveness of quasirandom sequences").
  static double phase(int i, int j) {
    const double p = 0.5 + i * 0.7548776662466927 + j * 0.5698402909980532;
    return p - std::floor(p);
  }
  Vec3d site(int i, int j, double along) const {
    return middle_ + along_ * along + across_ * ((i + 0.5) * spacing_) + over_ * ((j + 0.5) * spacing_);
  }
  bool inside(int i, int j, double along) const { return shape_.distance(site(i, j, along)) < 0; }

  const Region& shape_;
  double spacing_, depth_;
  Vec3d along_, across_, over_, middle_;
  int columns_, rows_;
};

}  // namespace dreampm
