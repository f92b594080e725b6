// The pressure of a still column of liquid, by rows of cells.
#pragma once
#include <cmath>
#include <vector>

#include "validate/measure/hydrostatic.h"

namespace dreampm::validate {

/// Mean errors of pressure by rows of cells from the floor up, against the exact ones at the
/// particles' own heights, relative to rho g H.
struct RowErrors {
  std::vector<double> error;
  double base() const { return error.front(); }
  double worst_above_the_base() const {
    double worst = 0;
    for (std::size_t r = 1; r < error.size(); ++r) worst = std::max(worst, std::abs(error[r]));
    return worst;
  }
};

/// Lets a pressed column settle under a damping of 20/s until `settle` [s], then averages over
/// `watch` [s]. The liquid is set 0, its floor at the origin's height.
template <class R, class Step>
RowErrors column_errors(World<R>& w, const Hydrostatic& rest, double height, double settle, double watch,
                        const Step& step) {
  w.settings.damping = 20;
  while (w.time < settle) step();
  w.settings.damping = 0;
  const auto rows = static_cast<std::size_t>(std::lround(height / w.dx));
  std::vector<double> sum(rows, 0), n(rows, 0);
  const double end = std::max(w.time, settle) + watch;
  while (w.time < end) {
    step();
    if (w.step % 20) continue;
    const auto e = ParticleSetView<R>(w, 0).column("e");
    each_particle(w, [&](std::size_t s, std::size_t p, const Vec3d& at) {
      if (s != 0) return;
      const double y = at.y - w.origin.y;
      const std::size_t row = std::min(static_cast<std::size_t>(y / w.dx), rows - 1);
      sum[row] += rest.pressure(static_cast<double>(e[p])) - rest.pressure_at(y);
      n[row] += 1;
    });
  }
  for (std::size_t r = 0; r < rows; ++r) sum[r] /= n[r] * rest.pressure_at(0);
  return {std::move(sum)};
}

}  // namespace dreampm::validate
