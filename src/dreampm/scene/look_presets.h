// Looks with a name: measured or chosen values of known matter.
#pragma once
#include <span>
#include <string_view>

#include "dreampm/model/render.h"

namespace dreampm::scene {

struct LookPreset {
  std::string_view name;
  model::Look look;
  std::string_view source;
};

std::span<const LookPreset> look_presets();
/// Null if there is none.
const model::Look* look_preset(std::string_view name);

/// The look that a material has where the scene gives none. `preset`: that of its values, or empty.
model::Look default_look(std::string_view type, std::string_view preset, bool liquid);

}  // namespace dreampm::scene
