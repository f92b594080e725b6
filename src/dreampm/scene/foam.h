// Which matter foams.
#pragma once
#include "dreampm/model/scene.h"

namespace dreampm::scene {

enum class FoamKind {
  none,   ///< it sends nothing out
  water,  ///< spray, foam and bubbles
  dust
};
FoamKind foam_kind(const model::Material& material);

/// Whether a material is of those that `foam` names, and foams.
bool foams(const model::Foam& foam, const model::Material& material);
/// The materials that foam by the scene's `foam`, as numbers. None without that key.
std::vector<int> foaming_materials(const model::Scene& scene);

}  // namespace dreampm::scene
