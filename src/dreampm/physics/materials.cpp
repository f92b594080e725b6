#include "dreampm/physics/materials.h"

#include <vector>

namespace dreampm {

std::span<const MaterialInfo> material_infos() {
  static const std::vector<MaterialInfo> infos = [] {
    std::vector<MaterialInfo> list;
    Materials::for_each([&]<class M>() { list.push_back(M::info); });
    return list;
  }();
  return infos;
}

const MaterialInfo* find_material(std::string_view name) {
  for (const MaterialInfo& m : material_infos())
    if (m.name == name) return &m;
  return nullptr;
}

}  // namespace dreampm
