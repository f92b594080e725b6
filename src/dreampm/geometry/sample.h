// Fills a region with points, one a particle.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/geometry/region.h"
#include "dreampm/model/matter.h"

namespace dreampm {

/// Points inside `region` [m] at a number density of 1/spacing^3. The cells are centered on the
/// region's bounds, so a box whose sides are whole spacings is filled flush, and a moved region
/// gives the same pattern, moved. No two points are nearer than spacing/2, none has distance >= 0.
/// The same for every thread count; `seed` feeds jitter and poisson. The number of poisson points
/// is that density times the volume but for chance at the surface: about 0.5 (area /
/// spacing^2)^(1/2) of them. They come in copies of one cube of at most 24 spacings. Throws
/// InputError for an unbounded region, or when the bounds hold more than 2^36 cells.
std::vector<Vec3d> sample_region(const Region& region, double spacing, Pattern pattern, std::uint64_t seed);

}  // namespace dreampm
