// Which solver moves a scene, and what each of them can do with it.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/playground.h"

namespace dreampm::play {

/// As scenes and scripts have them, in the order of SolverKind.
const std::vector<std::string>& solver_names();
bool is_projection(const model::Scene& scene);

/// The scene by the other solver: as its file has it, or else of the same particles. Throws
/// InputError where the scene cannot have another.
PlayScene by_solver(PlayScene scene, SolverKind solver);
/// Why a scene cannot be moved by the solver that does not move it now; empty: it can.
std::string why_not_other(const PlayScene& scene);

/// Why the solver of a scene cannot do with each kind of matters(); empty: it can.
std::vector<std::string> matter_refusals(const model::Scene& scene);

/// One material of each kind with its look, in the order of matters().
const model::Scene& scene_of_kinds();

/// What makes a liquid another one.
struct Liquid {
  double density, viscosity;  ///< kg/m^3, Pa s
  model::Look look;
};
/// What the one liquid of a scene takes on to be that kind of matter, where the solver moves one
/// liquid alone.
std::optional<Liquid> other_liquid(const model::Scene& scene, std::size_t kind);

/// As far as the solver of a scene lets a parameter of one of its materials go: towards `end`, from
/// where it is.
double allowed_end(const model::Scene& scene, const model::Material& material, const std::string& key, double end);
/// Whether that parameter has an effect with the solver of the scene.
bool has_effect(const model::Scene& scene, const model::Material& material, std::string_view key);

}  // namespace dreampm::play
