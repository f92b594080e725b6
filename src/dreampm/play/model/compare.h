// A and B: the same scene twice, under the same tools, with different materials.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/play/model/control.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

struct PlayModel;

/// The material of which there is most; where all matter is still to come, that of the first
/// emitter.
std::string main_material(const Simulation& simulation);
/// Sets the matter that tools give to that of the scene, and what it is compared with to another.
/// `refusals`: why the solver cannot do with each kind; empty: it can.
void choose_matter(const Simulation& simulation, const std::vector<std::string>& refusals, Settings& settings);
/// Makes `second` go on where `first` is, but for its past, with that kind of matter in place of
/// the main one. Throws InputError where the solver cannot do with it.
void begin_second_side(PlayModel& second, const PlayModel& first, std::optional<std::size_t> kind);

}  // namespace dreampm::play
