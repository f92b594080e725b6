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
    const StressResponse<double> rest = law.respond(s);
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

namespace {

/// Returns the largest speed that follows from an impact at `speed` that strains along `direction`:
/// of the waves behind the front, or of the front itself as arriving matter meets it. The strain
/// grows by a little from one try to the next, then by halves up to the jump of momentum.
template <class M>
double driven(const typename M::template Law<double>& law, const Mat3d& direction, double most, double speed,
              double density) {
  constexpr double first = 0.02, growth = 1.15, short_time = 1e-6;
  typename M::template State<double> s;
  for (int c = 0; c < state_columns<M>; ++c) s[c] = M::template State<double>::rest[c];
  Mat3d f = Mat3d::identity();
  double fastest = 0, strain = 0;
  int halvings = 0;
  for (double step = first; strain < most && halvings < 12;) {
    const Mat3d gradient = direction * step, strained = f + gradient * f;
    auto next = s;
    const StressResponse<double> r =
        law.advance(next, StrainIncrement<double>{gradient, short_time, determinant(strained), 0});
    // Both are of direction_ij: the stress of the rest area by F^-T.
    const double there = max(1 - strained(0, 0), strained(0, 1));
    const double stress = max(-r.tau.xx / strained(0, 0), r.tau.xy);
    const bool beyond = there * stress > density * speed * speed;
    if (beyond) {
      step /= 2, ++halvings;
      continue;
    }
    s = next, f = strained, strain = there, fastest = max(fastest, r.sound_speed);
    if (halvings == 0) step = min(step * growth, 0.25);  // never through itself
  }
  return max(fastest, speed + speed / strain);
}

}  // namespace

double shock_wave_speed(std::string_view material, const Values& values, double speed) {
  constexpr double slow = 0.3, most_pressed = 0.8, most_sheared = 3;
  double shock = 0;
  const bool known = Materials::with(material, [&]<class M>() {
    const auto law = M::template Law<double>::from(values);
    typename M::template State<double> rest;
    for (int c = 0; c < state_columns<M>; ++c) rest[c] = M::template State<double>::rest[c];
    if (speed < slow * law.respond(rest).sound_speed) return;
    const double density = values["density"];
    Mat3d shear{};
    shear(0, 1) = 1;
    shock = max(driven<M>(law, Mat3d::diagonal(-1, 0, 0), most_pressed, speed, density),
                driven<M>(law, shear, most_sheared, speed, density));
  });
  if (!known) throw std::out_of_range("no material of that name");
  return shock;
}

const MaterialInfo* find_material(std::string_view name) {
  for (const MaterialInfo& m : material_infos())
    if (m.name == name) return &m;
  return nullptr;
}

const MaterialInfo& info_of(const model::Material& material) {
  if (const MaterialInfo* info = find_material(material.type)) return *info;
  throw std::out_of_range("no material of type " + material.type);
}

}  // namespace dreampm
