// A matte base under a clear, rough coat.
#include "dreampm/render/glossy.h"
#include "dreampm/render/looks.h"

namespace dreampm::trace {
namespace {

class Plastic final : public Look {
 public:
  using Look::Look;
  std::unique_ptr<const Bsdf> bsdf(float outer_ior) const override {
    return std::make_unique<Coated>(static_cast<float>(model().roughness), outer_ior);
  }
};

}  // namespace

std::unique_ptr<const Look> make_plastic(const model::Look& look) { return std::make_unique<Plastic>(look); }

}  // namespace dreampm::trace
