// Stage 4: the sum of all kernels on a sparse grid.
#pragma once
#include <vector>

#include "dreampm/surface/kernels.h"
#include "dreampm/surface/solids.h"
#include "dreampm/surface/sparse_field.h"
#include "dreampm/surface/walls.h"

namespace dreampm::surface {

struct FieldSettings {
  float spacing;  ///< m
  float support;  ///< m
  float voxel;    ///< m
};

/// Values near the surface only: leaves whose cells are all `deep` become `inside`. Beyond a wall
/// the field is f = min(f, 1/2 - distance to the wall / (4 spacing)); before it f is left as it is,
/// so that the line where the surface meets the wall is as calm as the rest. Leaves
/// that solids reach into have values. `grid` holds the kernels' centers.
SparseField make_field(const std::vector<Kernel>& kernels, const CellGrid& grid, const std::vector<std::uint8_t>& deep,
                       const Walls& walls, const Solids& solids, const FieldSettings& settings);

}  // namespace dreampm::surface
