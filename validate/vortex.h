// The vortex of Taylor and Green, which the cases taylor-green and convergence share.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "validate/measure/fit.h"
#include "validate/validation_run.h"

namespace dreampm::validate {

struct VortexDecay {
  double rate = 0;                        ///< of ln KE from a tenth of the run on, relative to the exact one
  double excess = 0;                      ///< the viscosity [m^2/s] that would explain what the rate is too large by
  double heat = 0;                        ///< of viscosity, over the kinetic energy that was lost
  double exact_rate = 0;                  ///< 1/s
  double pace = 0;                        ///< steps a second
  std::vector<double> times, log_energy;  ///< s, ln(KE/KE0)
};

/// The liquid of a vortex.
struct VortexLiquid {
  double factor = 1;                      ///< times the viscosity, for controls
  std::string transfer = "apic";          ///< apic, flip or asflip
  std::optional<double> flip_blend = {};  ///< of flip and asflip
  int seed = 1;                           ///< of the draw of its points
  double damping = 0;                     ///< 1/s, for controls: takes energy that is no heat of viscosity
};

/// The number of draws of its points over which a result is the mean: one alone differs from the
/// next by up to 0.3 % of the rate.
inline constexpr int vortex_draws = 4;

/// The scene taylor-green at `cells` a side, a slab 4 cells thick, with speeds of at most 1 m/s;
/// `nu` [m^2/s] is that of the exact solution. Filled 1 % over rest density: with less pressure its
/// core cavitates, as the liquid cannot pull.
VortexDecay vortex_decay(Trial& trial, int cells, double nu, const VortexLiquid& liquid = {});

/// The same with as many draws.
std::vector<VortexDecay> vortex_decays(Trial& trial, int cells, double nu, VortexLiquid liquid = {});

/// Returns the mean of `value` over the draws.
template <class Value>
Mean mean_of(const std::vector<VortexDecay>& draws, const Value& value) {
  std::vector<double> values;
  for (const VortexDecay& v : draws) values.push_back(value(v));
  return mean_of(values);
}

/// Returns the mean of the draws' decay rates.
inline Mean rate_error(const std::vector<VortexDecay>& draws) {
  return mean_of(draws, [](const VortexDecay& v) { return v.rate - 1; });
}

}  // namespace dreampm::validate
