// The standing wave in a bar, which the cases bar-wave and convergence share.
#pragma once
#include <string>
#include <vector>

#include "validate/measure/fit.h"
#include "validate/validation_run.h"

namespace dreampm::validate {

struct BarWave {
  double period = 0, amplitude = 0;  ///< relative to the exact ones, the amplitude after two periods
  double worst = 0;                  ///< the largest difference of the mode's amplitude from the exact one, relative
  Swing swing;                       ///< in units of the exact period and amplitude

  Curve curve(std::string name) const { return {std::move(name), swing.times, swing.values}; }
  Curve exact() const;
};

/// Three periods of the bar of a built-in scene at `cells` cells of length. The exact wave is that
/// of the scene without `overrides`, which are for controls. Throws InputError.
BarWave ring_bar(Trial& trial, const std::string& scene, int cells, const std::vector<std::string>& overrides = {});

}  // namespace dreampm::validate
