// What a scene's `foam` means in numbers.
#pragma once
#include "dreampm/foam/foam.h"
#include "dreampm/model/scene.h"

namespace dreampm {

/// The rules of `foam` for matter on a grid of cells of `rules.cell`, of which there are at most
/// `volume` [m^3]: fills in scale, rate, radius, life and what else does not hang on limits.
/// `rules` has room, gravity, spacing, cell, seed and shift.
FoamRules foam_rules(const model::Foam& foam, FoamRules rules, double volume);
/// The same in the box of a scene. `shift`: where places of the matter count from.
FoamRules foam_rules(const model::Foam& foam, const model::Scene& scene, bool dust, const Vec3d& shift, double volume);

/// Whether every limit is given, so that no frame has to be looked at for them.
bool limits_given(const model::Foam& foam);
/// The limits of the rules: as given, else as found.
void set_limits(FoamRules& rules, const model::Foam& foam, const FoamFound& found);

}  // namespace dreampm
