// Light on a plane: values at the middles of square cells.
#pragma once
#include <cstddef>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm::trace {

struct LightGrid {
  int width = 0, height = 0;
  float cell = 0;             ///< m
  std::vector<Vec3f> values;  ///< row by row

  /// Cells that cover so much [m], all 0.
  static LightGrid covering(float wide, float deep, float cell);
  /// Between the middles of cells, for u, v in cells from the first corner; beyond the grid the
  /// value at its edge.
  Vec3f at(float u, float v) const;
  /// By a Gaussian of that width [cells], edges repeated.
  void blur(float sigma);
};

}  // namespace dreampm::trace
