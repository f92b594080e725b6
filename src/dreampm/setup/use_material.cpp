// Particle sets from materials: the parameters that a set takes, and limits that follow from the
// speed of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/physics/param.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {
namespace {

void derive_bulk_modulus(model::Material& material, const ExpectedSpeed& expected, std::vector<std::string>& notes) {
  if (!info_of(material).find("max_compression") || material.values.has("bulk_modulus")) return;
  const double density = material.values["density"];
  // Without fall or speed a slow sound still has to hold the liquid together.
  const double c = std::max(expected.speed, 0.1) / std::sqrt(material.values["max_compression"]);
  material.values.set("bulk_modulus", density * c * c);
  notes.push_back(
      fmt::format("{}: bulk modulus {:.4g} Pa, sound speed {:.3g} m/s, from the largest expected speed {:.3g} m/s{}",
                  material.name, density * c * c, c, expected.speed, expected.sources));
}

/// A liquid's J follows the measured density at the pace of its flow: tau = 30 dx/v_ref (LIQUID),
/// which laws know as 300 dx/c, with c = 10 v_ref. One that is much stiffer would be repacked at
/// the pace of its sound, and be thrown apart by an energy that no fall has: the pace of c = 20
/// v_ref is the most. Nothing is changed where no speed is known beforehand.
void limit_relaxation(model::Material& material, double v_ref, std::vector<std::string>& notes) {
  if (!info_of(material).find("relaxation") || !material.values.has("bulk_modulus") || !(v_ref > 0)) return;
  const double c = std::sqrt(material.values["bulk_modulus"] / material.values["density"]), most = 20 * v_ref;
  const double given = material.values["relaxation"];
  if (c <= most || given == 0) return;
  material.values.set("relaxation", given * most / c);
  notes.push_back(
      fmt::format("{}: relaxation {:.3g} acts as {:.3g}, since sound is {:.3g} times the largest expected speed",
                  material.name, given, given * most / c, c / v_ref));
}

}  // namespace

template <class R>
void use_material(ParticleSet<R>& set, model::Material material, const World<R>& world, const ExpectedSpeed& expected,
                  std::vector<std::string>& notes) {
  // A projection has no use for stiffness.
  set.carries_motion = world.settings.solver == SolverKind::projection;
  const bool projected = set.carries_motion && info_of(material).liquid;
  if (projected && material.values.has("bulk_modulus"))
    notes.push_back(fmt::format("{}: bulk_modulus has no effect: a projection keeps volume as it is", material.name));
  std::vector<std::string> unused;
  std::vector<std::string>& of_stiffness = projected ? unused : notes;
  derive_bulk_modulus(material, expected, of_stiffness);
  limit_relaxation(material, expected.speed, of_stiffness);
  set.name = material.name;
  set.material = material.type;
  set.liquid = info_of(material).liquid;
  set.mass = material.values["density"] * set.rest_volume;
  set.values = material.values;
  double gravity = length(world.gravity);
  for (const Key<Vec3d>& k : world.gravity_keys) gravity = std::max(gravity, length(k.value));
  const CellTimes cell{world.dx / facts_of(info_of(material), material.values).sound_speed,
                       set.liquid && gravity > 0 ? std::sqrt(world.dx / gravity) : 0};
  set.transfer = std::visit([&](const auto& t) { return t.rule(cell); },
                            make_transfer(material.transfer, material.transfer_values));
}
#define DM_INSTANTIATE(R)                                                                             \
  template void use_material(ParticleSet<R>&, model::Material, const World<R>&, const ExpectedSpeed&, \
                             std::vector<std::string>&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
