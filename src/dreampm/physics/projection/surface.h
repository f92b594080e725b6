// The free surface of a liquid on a staggered grid: how deep cells lie under it, and what the
// pressure solve makes of a surface between two cells.
#pragma once
#include "dreampm/math/scalar.h"

namespace dreampm {

/// Numbers of the surface, in cells.
struct LiquidSurface {
  static constexpr double least_depth = 0.02;    ///< of a cell of liquid
  static constexpr double least_height = 0.001;  ///< of a cell of air above it
  static constexpr double least_theta = 0.05;    ///< from a cell's center to the surface
};

/// Depth of a cell's center under the surface in cells, negative above it, from the density that
/// the cell reads through a trilinear kernel, over that at rest. A half-space that ends d above the
/// center reads 1 - (1 - d)^2/2 for d in [0, 1] and (1 + d)^2/2 for d in [-1, 0]: this is the
/// inverse, exact for surfaces along the axes.
template <class R>
DM_FN R depth_of(R density) {
  using S = Scalar<R>;
  const R half = R(S(0.5)), one = R(S(1)), two = R(S(2));
  const R inside = one - sqrt(max(two - two * min(density, one), R(S(0))));
  const R above = sqrt(max(two * density, R(S(0)))) - one;
  const R depth = select(density > half, inside, above);
  return select(depth > R(S(0)), max(depth, R(S(LiquidSurface::least_depth))),
                min(depth, R(S(-LiquidSurface::least_height))));
}

/// 1/theta of the face between two cells by their depths: theta is the part of the way from the
/// liquid cell to the other one that ends at the surface, where the pressure is 0 (the ghost fluid
/// method of Enright, Nguyen, Gibou and Fedkiw 2003); 1 where both are liquid or neither is.
template <class R>
DM_FN R inverse_theta(R depth, R other) {
  using S = Scalar<R>;
  const R zero = R(S(0));
  const R in = max(depth, other), out = min(depth, other);
  const R theta_way = max(in, R(S(LiquidSurface::least_theta)) * (in - out));
  const auto across = in > zero && out <= zero;
  return select(across, (in - out) / select(across, theta_way, R(S(1))), R(S(1)));
}

/// Returns the change of velocity that a field q of cells causes at the face between two of them,
/// by their depths; `lightness`: the density of the liquid over that of the matter at the face.
template <class R>
DM_FN R slope_across(R q, R below, R lightness, R depth, R depth_below) {
  return (q - below) * lightness * inverse_theta(depth, depth_below);
}

}  // namespace dreampm
