#include "dreampm/physics/materials/elastic.h"
#include "dreampm/physics/materials/newtonian.h"
#include "dreampm/physics/materials/seed.h"
#include "dreampm/physics/param.h"

namespace dreampm {
namespace {
constexpr MaterialInfo infos[] = {
    {"newtonian", "a weakly compressible liquid with true viscosity", newtonian_params, newtonian_presets, true},
    {"elastic", "a fixed corotated elastic solid: jelly, rubber", elastic_params, elastic_presets, false},
    {"seed", "the report's material: liquid, sticky liquid or stone by one slider", seed_params, {}, false},
};
}  // namespace

std::span<const MaterialInfo> material_infos() { return infos; }

const MaterialInfo* find_material(std::string_view name) {
  for (const MaterialInfo& m : infos)
    if (m.name == name) return &m;
  return nullptr;
}

}  // namespace dreampm
