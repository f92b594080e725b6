// What clear matter of several colors absorbs, from place to place.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

/// Absorption [1/m] at the middles of the cubic cells of a box, between them linear, beyond them as
/// at the edge.
struct AbsorptionField {
  Vec3f corner{};  ///< m, the least one of the box
  float cell = 1;  ///< m
  std::array<int, 3> size{1, 1, 1};
  std::vector<Vec3f> values;  ///< x runs fastest

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(x);
  }
  Vec3f at(const Vec3f& p) const;
  /// The share that is left after t [m] from o along the unit vector d: Beer-Lambert's law, whose
  /// integral is a sum over steps of a cell or less.
  Vec3f left(const Vec3f& o, const Vec3f& d, float t) const;
};

}  // namespace dreampm
