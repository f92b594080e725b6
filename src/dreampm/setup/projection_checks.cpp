#include "dreampm/setup/projection_checks.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/physics/param.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/setup/place.h"
#include "dreampm/solver/projection/mac_grid.h"

namespace dreampm {
namespace {

constexpr const char* remedy = "; leave time.solver out, or say explicit";

void check_materials(const model::Scene& scene, const std::string& file, std::vector<std::string>& out) {
  const model::Material* liquid = nullptr;
  for (const model::Material& m : scene.materials) {
    const std::string at = place(file, scene, m);
    if (is_projected(m.type) && m.values["tension"] != 0)
      out.push_back(
          fmt::format("{}: error: material {} has tension, which time.solver: projection does not have; take "
                      "the key out",
                      at, m.name));
    if (m.transfer != Apic::name)
      out.push_back(
          fmt::format("{}: error: material {}: time.solver: projection has the transfer apic alone; take the "
                      "key out",
                      at, m.name));
    if (!is_projected(m.type)) continue;
    if (!liquid) liquid = &m;
    for (const char* value : {"density", "viscosity"})
      if (m.values[value] != liquid->values[value])
        out.push_back(
            fmt::format("{}: error: materials {} and {} differ in {}: time.solver: projection moves liquids that are "
                        "alike{}",
                        at, liquid->name, m.name, value, remedy));
  }
  if (!liquid && out.empty())
    out.push_back(
        fmt::format("{}: error: time.solver: projection moves liquids, and there is no liquid{}", file, remedy));
}

void check_space(const model::Space& space, const std::string& file, std::vector<std::string>& out) {
  const Vec3i cells = space.cells();
  for (int a = 0; a < 3; ++a)
    if (space.periodic[static_cast<std::size_t>(a)] && cells[a] % period_cells != 0)
      out.push_back(fmt::format(
          "{}: error: space.periodic has {}, along which there are {} cells, and time.solver: projection wants a "
          "multiple of {}: make space.max {:.6g} m there",
          file, "xyz"[a], cells[a], period_cells,
          space.min[a] + (cells[a] / period_cells + 1) * period_cells * space.dx()));
}

}  // namespace

std::vector<std::string> projection_refusals(const model::Scene& scene, const std::string& file) {
  std::vector<std::string> out;
  if (scene.time.solver != SolverKind::projection) return out;
  check_materials(scene, file, out);
  check_space(scene.space, file, out);
  const auto refuse = [&](const model::Collider& c, const std::string& what) {
    out.push_back(
        fmt::format("{}: error: {} {}: time.solver: projection knows liquids between walls and colliders, "
                    "emitters and sinks{}",
                    place(file, scene, c), what, c.name, remedy));
  };
  for (const model::Collider& c : scene.colliders)
    if (c.pin || c.holds) refuse(c, c.pin ? "pin" : "collider that holds matter,");
  return out;
}

std::string projection_warning(const model::Scene& scene, const std::string& file) {
  if (scene.time.solver != SolverKind::projection || !(scene.time.cfl > usual_projection_cfl)) return {};
  return fmt::format(
      "{}: time.cfl is {:.3g}: above {} it is for previews, for thin sheets jump into the bulk before they are "
      "stopped, "
      "and a splash may be a tenth too dense for some frames",
      file, scene.time.cfl, usual_projection_cfl);
}

}  // namespace dreampm
