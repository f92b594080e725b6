// A matte surface, under a clear coat where roughness < 1; balls of particles, without a coat.
#include "dreampm/render/glossy.h"
#include "dreampm/render/looks.h"

namespace dreampm::trace {
namespace {

class Opaque final : public Look {
 public:
  using Look::Look;
  std::unique_ptr<const Bsdf> bsdf(float outer_ior) const override {
    if (model().roughness >= 1) return std::make_unique<Matte>();
    return std::make_unique<Coated>(static_cast<float>(model().roughness), outer_ior);
  }
};

class Spheres final : public Look {
 public:
  using Look::Look;
  std::unique_ptr<const Bsdf> bsdf(float) const override { return std::make_unique<Matte>(); }
};

}  // namespace

std::unique_ptr<const Look> make_opaque(const model::Look& look) { return std::make_unique<Opaque>(look); }
std::unique_ptr<const Look> make_spheres(const model::Look& look) { return std::make_unique<Spheres>(look); }

}  // namespace dreampm::trace
