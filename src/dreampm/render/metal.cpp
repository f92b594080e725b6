// A rough conductor.
#include "dreampm/render/glossy.h"
#include "dreampm/render/looks.h"

namespace dreampm::trace {
namespace {

class Metal final : public Look {
 public:
  using Look::Look;
  std::unique_ptr<const Bsdf> bsdf(float) const override {
    return std::make_unique<Conductor>(static_cast<float>(model().roughness));
  }
};

}  // namespace

std::unique_ptr<const Look> make_metal(const model::Look& look) { return std::make_unique<Metal>(look); }

}  // namespace dreampm::trace
