// Looks with a name: measured or chosen values of known matter.
#pragma once
#include <span>
#include <string_view>

#include "dreampm/model/render.h"

namespace dreampm::scene {

struct LookPreset {
  std::string_view name;
  model::Look look;
  bool is_default = false;  ///< a material of this preset or type has it where the scene gives no look
};

std::span<const LookPreset> look_presets();
/// Null if there is none.
const LookPreset* look_preset(std::string_view name);

/// The look that a material has where the scene gives none. `preset`: that of its values, or empty.
model::Look default_look(std::string_view type, std::string_view preset, bool liquid);

}  // namespace dreampm::scene
