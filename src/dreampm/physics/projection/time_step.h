// How long a step of the projection is.
#pragma once
#include <algorithm>
#include <cmath>

#include "dreampm/physics/dt.h"

namespace dreampm {

/// Cells that matter crosses in a step of the projection, unless a scene says otherwise, and the
/// most that it may say. In longer steps thin sheets jump into the bulk before they
/// are stopped.
inline constexpr double usual_projection_cfl = 2, largest_projection_cfl = 3;

/// The speeds of matter.
struct FlowSpeeds {
  double usual = 0;    ///< m/s, that all but 0.1 % of the particles keep
  double fastest = 0;  ///< m/s
};

/// Cells to cross where liquid is crowded, by the part of its volume that is too much: half as many
/// from `most_crowding` on.
inline double crowded_cfl(double cfl, double crowding) {
  constexpr double most_crowding = 0.002;
  return cfl / (1 + std::min(1.0, crowding / most_crowding));
}

/// Usual matter crosses `cfl` cells, with what it may gain by falling; the fastest at most two and
/// a half times as many, and `most_cells`; waves of a cell's length move by half a radian.
inline StepBound projection_bound(double cfl, double dx, double gravity, const FlowSpeeds& flow, double most_cells) {
  StepBound bound{1e30, Limiter::frame};
  if (gravity > 0) bound = {0.5 * std::sqrt(dx / gravity), Limiter::wave};
  const double gain = gravity > 0 ? 0.5 * gravity * bound.dt : 0;
  const double cells = std::max({flow.usual / cfl, flow.fastest / (2.5 * cfl), flow.fastest / most_cells}) + gain / cfl;
  if (cells > 0 && dx / cells < bound.dt) bound = {dx / cells, Limiter::speed};
  return bound;
}

}  // namespace dreampm
