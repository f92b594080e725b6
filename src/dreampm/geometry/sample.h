// Fills a region with points, one a particle.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/geometry/region.h"

namespace dreampm {

enum class Pattern {
  lattice,  ///< the centres of cubic cells
  jitter    ///< those, each moved by up to a quarter of the spacing along every axis
};

/// Points inside `region` [m] at a number density of 1/spacing^3. The cells are centred on the region's bounds, so a
/// box whose sides are whole spacings is filled flush, and a moved region gives the same pattern, moved. No two points
/// are nearer than spacing/2, none has distance >= 0. The same for every thread count; `seed` feeds the jitter only.
/// Throws InputError for an unbounded region, or when the bounds hold more than 2^36 cells.
std::vector<Vec3d> sample_region(const Region& region, double spacing, Pattern pattern, std::uint64_t seed);

}  // namespace dreampm
