// A smooth interface around a medium that absorbs by Beer-Lambert, and scatters where it is cloudy:
// water, honey, glass, milk.
#include <algorithm>
#include <cmath>

#include "dreampm/math/look_color.h"
#include "dreampm/render/looks.h"

namespace dreampm::trace {
namespace {

class Dielectric final : public Look {
 public:
  explicit Dielectric(const model::Look& look) : Look(look) {
    interior_.ior = static_cast<float>(look.ior);
    interior_.absorption = static_cast<Vec3f>(look.absorption);
    interior_.scattering = static_cast<Vec3f>(look.scattering);
    interior_.extinction = interior_.absorption + interior_.scattering;
    interior_.anisotropy = static_cast<float>(look.anisotropy);
    interior_.scatters = look.scattering.x > 0 || look.scattering.y > 0 || look.scattering.z > 0;
    if (!interior_.scatters) interior_.glow = glow_of(interior_.absorption);  // else it is traced
  }
  const Interior* interior() const override { return &interior_; }
  std::unique_ptr<const Bsdf> bsdf(float) const override { return nullptr; }
  Vec3f color() const override { return linear_color(model()); }

 private:
  Interior interior_;
};

}  // namespace

// What its absorption lets through over a few decimeters, none in a clear one.
Vec3f glow_of(const Vec3f& absorption) {
  const float strength = 0.36f * std::min(1.0f, std::max({absorption.x, absorption.y, absorption.z}) / 6);
  const auto channel = [&](float a) { return strength * std::exp(-0.22f * std::pow(a, 1.38f)); };
  return {channel(absorption.x), channel(absorption.y), channel(absorption.z)};
}

std::unique_ptr<const Look> make_dielectric(const model::Look& look) { return std::make_unique<Dielectric>(look); }

}  // namespace dreampm::trace
