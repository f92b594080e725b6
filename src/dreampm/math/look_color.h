// The color of a look where it is not traced: in exports, as an attribute of particles, on the
// screen.
#pragma once
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

/// Linear: the color of a look, or what `shown_layer` of clear matter lets through.
inline Vec3f linear_color(const model::Look& look) {
  return look.type == model::LookType::dielectric ? light_through(look.absorption) : linear_color(look.color);
}

}  // namespace dreampm
