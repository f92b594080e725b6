// Random points that keep their distance, and leave no room for another one.
#pragma once
#include <cstdint>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

/// A periodic cube of points; its copies side by side fill space.
struct PoissonTile {
  std::vector<Vec3d> points;  ///< in [0, 1)^3, neighbors together
  double distance;            ///< least distance between two points, across the faces too; in sides of the cube
};

/// A maximal Poisson-disk sample of about `side`^3 points, 6 <= side <= 64: every place of the cube
/// is nearer than `distance` to a point. Distributed as random darts that hit free room, so no
/// direction is preferred. Equal for equal arguments. Linear time. Ebeida et al. 2012, "A Simple
/// Algorithm for Maximal Poisson-Disk Sampling in High Dimensions".
PoissonTile poisson_tile(int side, std::uint64_t seed);

}  // namespace dreampm
