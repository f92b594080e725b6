// How soft elastic matter may be where it is: softer, it would be pressed flat, and not come back.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// What presses on a material.
struct Press {
  double above = 0;   ///< kg/m^2: what lies on its lowest part, its own weight too
  double own = 0;     ///< kg/m^2: of that, its own
  double fall = 0;    ///< m: what it may fall
  double speed2 = 0;  ///< m^2/s^2: of its motion, the mean square

  /// Pa: of its weight, of what a fall brings, and of its motion, at that density, where its own is
  /// `was`.
  double load(double gravity, double density, double was) const {
    return gravity * (above + own * (density / was - 1) + density * fall) + 0.5 * density * speed2;
  }
};

/// Whether sliders must keep it firm: it is elastic, with no flow by which it gives way.
bool is_elastic(const model::Material& material);
/// Whether such matter is less firm with another value of that parameter.
bool is_of_firmness(std::string_view key);

/// The modulus of compression at rest [Pa], rho c^2, over the load: above it a body that is pressed
/// or falls has its shape again, to 5 % of its volume (measured: blocks under a stone as heavy,
/// balls that fall 0.3 and 0.8 m).
inline constexpr double least_firmness = 4;

/// Of the materials of the scene; empty for those that are not elastic, or of which there is
/// nothing.
std::vector<std::optional<Press>> presses_on(const Simulation& simulation);

}  // namespace dreampm::play
