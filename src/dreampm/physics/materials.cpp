#include "dreampm/physics/materials.h"

#include <stdexcept>
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

MaterialFacts facts_of(const MaterialInfo& info, const Values& values) {
  MaterialFacts facts{};
  const bool known = Materials::with(info.name, [&]<class M>() {
    const auto law = M::template Law<double>::from(values);
    typename M::template State<double> s;
    for (int c = 0; c < state_columns<M>; ++c) s[c] = M::template State<double>::rest[c];
    const Response<double> rest = law.respond(s);
    facts = {rest.sound_speed, rest.kinematic_viscosity, 0.5};
    if (M::template State<double>::names[0] != "f_00") return;
    // Pressed along x: tau_xx = (lambda + 2 mu) e and tau_yy = lambda e.
    s[0] -= 1e-6;
    const Sym3<double> t = law.respond(s).tau;
    facts.poissons_ratio = t.yy / (t.xx + t.yy);
  });
  if (!known) throw std::out_of_range("no material of that name");
  return facts;
}

const MaterialInfo* find_material(std::string_view name) {
  for (const MaterialInfo& m : material_infos())
    if (m.name == name) return &m;
  return nullptr;
}

}  // namespace dreampm
