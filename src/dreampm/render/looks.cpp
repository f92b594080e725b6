#include "dreampm/render/looks.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/srgb.h"

namespace dreampm::trace {
namespace {

/// Light scattered inside a thick layer: what its absorption lets through over a few decimeters,
/// none in a clear one.
Vec3f glow_of(const Vec3d& absorption) {
  const double strength = 0.36 * std::min(1.0, std::max({absorption.x, absorption.y, absorption.z}) / 6);
  const auto channel = [&](double a) { return static_cast<float>(strength * std::exp(-0.22 * std::pow(a, 1.38))); };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

}  // namespace

Look traced(const model::Look& look) {
  if (look.type == model::LookType::dielectric)
    return Dielectric{static_cast<float>(look.ior), static_cast<Vec3f>(look.absorption), glow_of(look.absorption)};
  const Vec3f color = linear_color(look.color);
  const auto roughness = static_cast<float>(look.roughness);
  switch (look.type) {
    case model::LookType::wood:
      return Wood{color, roughness, static_cast<float>(look.ring.value_or(0))};
    case model::LookType::metal:
      return Metal{color, roughness};
    case model::LookType::plastic:
      return Plastic{color, roughness};
    case model::LookType::opaque:
      return Opaque{color, roughness};
    default:
      return Opaque{color, 1};
  }
}

}  // namespace dreampm::trace
