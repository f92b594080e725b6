// How far the sliders of matter go before time nearly stands still, or before soft matter is
// crushed.
#pragma once
#include <string>
#include <vector>

#include "dreampm/play/model/control.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// Of the pace that is asked for: a slider that would make time slower than that holds.
inline constexpr double least_pace = 0.25;

/// Of each control: from where to where time runs at least at that pace, or no slower than it does
/// as all is set; and elastic matter is as firm as what presses on it asks for (firmness.h), or no
/// less firm than as all is set, whatever the machine. `values`: of the controls; `step_seconds`:
/// of the wall clock, that a step takes, 0 where that is not known; `asked`: simulated seconds a
/// second.
std::vector<LiveRange> live_ranges(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                                   const std::vector<double>& values, double step_seconds, double asked);

/// The first elastic material that is softer, as all is set, than what presses on it asks for;
/// empty: none.
std::string too_soft(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                     const std::vector<double>& values);

}  // namespace dreampm::play
