// The color of a look where it is not traced: in exports, as an attribute of particles, on the
// screen.
#pragma once
#include <algorithm>
#include <cmath>

#include "dreampm/math/srgb.h"
#include "dreampm/model/render.h"

namespace dreampm {

/// m: the layer of clear matter whose color stands for it.
inline constexpr double shown_layer = 0.1;

/// Linear: what a layer of clear matter lets through, by Beer-Lambert. `absorption` [1/m].
inline Vec3f light_through(const Vec3d& absorption, double layer = shown_layer) {
  const auto channel = [&](double a) { return static_cast<float>(std::exp(-layer * a)); };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

/// Linear: what a thick body of cloudy matter sends back, whatever its surface (Jensen et al. 2001,
/// "A practical model for subsurface light transport", eq. 15, with A = 1).
inline Vec3f diffuse_reflectance(const model::Look& look) {
  const auto channel = [&](int k) {
    const double s = look.scattering[k] * (1 - look.anisotropy), albedo = s / std::max(1e-12, s + look.absorption[k]),
                 root = std::sqrt(3 * (1 - albedo));
    return static_cast<float>(0.5 * albedo * (1 + std::exp(-4.0 / 3 * root)) * std::exp(-root));
  };
  return {channel(0), channel(1), channel(2)};
}

/// Can one see through a hand's breadth of it? Milk and snow are no longer clear.
inline bool is_clear(const model::Look& look) {
  const Vec3d& s = look.scattering;
  return look.type == model::LookType::dielectric && (s.x + s.y + s.z) / 3 * (1 - look.anisotropy) * shown_layer < 4;
}

/// Linear: the color of a look; what `shown_layer` of clear matter lets through; what cloudy matter
/// sends back.
inline Vec3f linear_color(const model::Look& look) {
  if (is_clear(look)) return light_through(look.absorption);
  return look.type == model::LookType::dielectric ? diffuse_reflectance(look) : linear_color(look.color);
}

/// sRGB: the color of a look that is not clear.
inline Vec3f shown_color(const model::Look& look) {
  if (look.type != model::LookType::dielectric) return static_cast<Vec3f>(look.color);
  const Vec3f c = diffuse_reflectance(look);
  return {srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z)};
}

}  // namespace dreampm
