// A look of the model as other programs know it: a color, how rough, whether metal or clear.
#pragma once
#include <optional>
#include <string>

#include "dreampm/math/vec.h"
#include "dreampm/model/render.h"

namespace dreampm::exchange {

/// How matter looks, as far as other programs know it.
struct ClipMaterial {
  std::string name;
  Vec3f color{0.8f, 0.8f, 0.8f};  ///< linear
  float roughness = 0.5f, metallic = 0;
  std::optional<float> ior{};  ///< of clear matter
};

/// Clear matter has the color that a layer of it lets through, and no roughness.
ClipMaterial material_of(const std::string& name, const model::Look& look);

}  // namespace dreampm::exchange
