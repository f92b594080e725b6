// Interpolation between the points of a lattice that is kept in leaves of 8^3.
#pragma once
#include <vector>

#include "dreampm/surface/lattice.h"

namespace dreampm::surface {

/// The leaf that holds a point of the lattice, and the place of the point in it, x fastest.
inline Vec3i leaf_of(const Vec3i& p) { return {p.x >> 3, p.y >> 3, p.z >> 3}; }
inline std::size_t place_in_leaf(const Vec3i& p) {
  return static_cast<std::size_t>(((p.z & 7) * 8 + (p.y & 7)) * 8 + (p.x & 7));
}

/// The points of a cube of `side`^3, in that order.
inline std::vector<Vec3i> cube(int side) {
  std::vector<Vec3i> points;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) points.push_back({x, y, z});
  return points;
}

/// The values of a leaf, or one for all of its points.
struct LeafValues {
  const float* values;  ///< 8^3, or null
  float otherwise;
  float at(const Vec3i& p) const { return values ? values[place_in_leaf(p)] : otherwise; }
};

/// Linear interpolation at `u`, in steps of the lattice. find(leaf) gives the LeafValues.
template <class Find>
float interpolated(const Vec3f& u, const Find& find) {
  const Vec3i i = lattice_cell(u, 1);
  const Vec3f f = u - Vec3f(i);
  Vec3i leaf = leaf_of(i);
  LeafValues of = find(leaf);
  float sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3i o{c & 1, c >> 1 & 1, c >> 2 & 1}, p = i + o;
    if (const Vec3i other = leaf_of(p); !(other == leaf)) leaf = other, of = find(leaf);
    sum += (o.x ? f.x : 1 - f.x) * (o.y ? f.y : 1 - f.y) * (o.z ? f.z : 1 - f.z) * of.at(p);
  }
  return sum;
}

}  // namespace dreampm::surface
