// Means of a number over cells, for pictures: single particles jump.
#pragma once
#include <span>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm::play {

/// Replaces each value by the mean around its particle, weighted by a tent of that half width [m]
/// along each axis: means at the nodes of a grid, read between them.
void average_over_cells(std::span<const Vec3f> position, double cell, std::vector<float>& value);

}  // namespace dreampm::play
