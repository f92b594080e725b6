#include "dreampm/export/material.h"

#include "dreampm/math/look_color.h"

namespace dreampm::exchange {

ClipMaterial material_of(const std::string& name, const model::Look& look) {
  ClipMaterial out;
  out.name = name;
  out.color = linear_color(look);
  const bool clear = is_clear(look);
  out.roughness = clear ? 0.0f : static_cast<float>(look.roughness);
  out.metallic = look.type == model::LookType::metal ? 1.0f : 0.0f;
  if (clear) out.ior = static_cast<float>(look.ior);
  return out;
}

}  // namespace dreampm::exchange
