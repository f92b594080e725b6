#include "dreampm/scene/look_presets.h"

#include <algorithm>
#include <array>

namespace dreampm::scene {

std::span<const LookPreset> look_presets() {
  using model::Look;
  static const std::array<LookPreset, 7> all{{
      {"water", Look::dielectric()},  // bluer than pure water, as a look
      {"glass", Look::dielectric(1.5, {0.4, 0.2, 0.3})},
      // Whole and skimmed milk: Jensen et al. 2001, "A practical model for subsurface light
      // transport", table 1.
      {"milk", Look::dielectric(1.3, {1.1, 2.4, 14}, {2550, 3210, 3770})},
      {"skim milk", Look::dielectric(1.3, {1.4, 2.5, 14.2}, {700, 1220, 1900})},
      // A blossom honey by eye; its index at 18 % of water.
      {"honey", Look::dielectric(1.49, {4, 16, 60}, {4, 4, 4}), true},
      {"jelly", Look::dielectric(1.35, {1.5, 34, 40}, {25, 25, 25}, 0.6)},  // strawberry, by eye
      // No smooth face: grains lie in air. Ice's absorption: Warren and Brandt 2008. Its reduced
      // scattering is 3 rho (1 - g)/(2 rho_ice r) for 300 kg/m^3, r = 0.1 mm, g = 0.89: Wiscombe
      // and Warren 1980.
      {"snow", Look::dielectric(1, {0.08, 0.03, 0.004}, {540, 540, 540}), true},
  }};
  return all;
}

const LookPreset* look_preset(std::string_view name) {
  const auto found = std::ranges::find(look_presets(), name, &LookPreset::name);
  return found == look_presets().end() ? nullptr : &*found;
}

model::Look default_look(std::string_view type, std::string_view preset, bool liquid) {
  for (const std::string_view name : {preset, type})
    if (const LookPreset* own = look_preset(name); own && own->is_default) return own->look;
  model::Look look;
  if (!liquid) look.type = model::LookType::opaque;
  return look;
}

}  // namespace dreampm::scene
