#include "dreampm/render/surfaces.h"

#include <utility>

namespace dreampm::trace {

Surfaces::Surfaces(const Geometry& geometry) : media_(geometry.objects() + 1) {
  // Objects that differ in color alone share one.
  std::vector<std::pair<std::pair<model::Look, float>, std::shared_ptr<const Bsdf>>> made;
  const auto shared = [&](int object, float ior) {
    const Look& look = geometry.look(object);
    std::pair<model::Look, float> key{look.model(), ior};
    key.first.color = {};
    for (const auto& [of, bsdf] : made)
      if (of == key) return bsdf;
    return made.emplace_back(key, look.bsdf(ior)).second;
  };
  for (int o = 0; o < geometry.objects(); ++o)
    for (int m = air; m < geometry.objects(); ++m) {
      const Interior* const around = geometry.interior(m);
      const bool possible = geometry.interior(o) == nullptr && (m == air || around != nullptr);
      surfaces_.push_back(possible ? shared(o, around == nullptr ? 1 : around->ior) : nullptr);
    }
}

}  // namespace dreampm::trace
