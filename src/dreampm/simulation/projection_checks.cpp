#include "dreampm/simulation/projection_checks.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/simulation/place.h"

namespace dreampm {
namespace {

constexpr const char* remedy = "; leave time.solver out, or say explicit";

void check_materials(const scene::SceneDescription& scene, const std::string& file, std::vector<std::string>& out) {
  const double dx = scene.space.dx();
  double gravity = length(scene.gravity);
  for (const Key<Vec3d>& k : scene.gravity_keys) gravity = std::max(gravity, length(k.value));
  const double step = std::min(1 / scene.time.fps, gravity > 0 ? 0.5 * std::sqrt(dx / gravity) : 1e30);
  for (const scene::Material& m : scene.materials) {
    const std::string at = place(file, m.mark);
    if (m.info->name != "newtonian") {
      out.push_back(
          fmt::format("{}: error: material {} is of type {}: time.solver: projection moves newtonian liquids "
                      "alone{}",
                      at, m.name, m.info->name, remedy));
      continue;
    }
    if (m.values["tension"] != 0)
      out.push_back(
          fmt::format("{}: error: material {} has tension, which time.solver: projection does not have; take "
                      "the key out",
                      at, m.name));
    if (!std::holds_alternative<Apic>(m.transfer))
      out.push_back(
          fmt::format("{}: error: material {}: time.solver: projection has the transfer apic alone; take the "
                      "key out",
                      at, m.name));
    const double density = m.values["density"], viscosity = m.values["viscosity"];
    if (viscosity / density * step > largest_projection_viscosity * dx * dx)
      out.push_back(
          fmt::format("{}: error: material {} has a viscosity of {} Pa s: time.solver: projection has none, "
                      "and at this spacing more than {:.2g} Pa s would be seen{}",
                      at, m.name, viscosity, largest_projection_viscosity * dx * dx * density / step, remedy));
    if (density != scene.materials.front().values["density"])
      out.push_back(
          fmt::format("{}: error: materials {} and {} differ in density: time.solver: projection moves "
                      "liquids of one density{}",
                      at, scene.materials.front().name, m.name, remedy));
  }
}

void check_space(const scene::Space& space, const std::string& file, std::vector<std::string>& out) {
  for (std::size_t w = 0; w < space.walls.size(); ++w) {
    const scene::Wall& wall = space.walls[w];
    if (space.periodic[w / 2]) {
      if (w % 2 == 0)
        out.push_back(fmt::format("{}: error: space.periodic has {}, and time.solver: projection wants walls{}", file,
                                  "xyz"[w / 2], remedy));
      continue;
    }
    const std::string name = fmt::format("space.walls.{}", scene::wall_names[w]);
    if (wall.type == WallType::stick)
      out.push_back(fmt::format("{}: error: {} is of type stick: along walls time.solver: projection slips{}", file,
                                name, remedy));
    if (wall.skin_friction)
      out.push_back(fmt::format("{}: error: {} has skin_friction: along walls time.solver: projection slips{}", file,
                                name, remedy));
  }
}

}  // namespace

std::vector<std::string> projection_refusals(const scene::SceneDescription& scene, const std::string& file) {
  std::vector<std::string> out;
  if (scene.time.solver != SolverKind::projection) return out;
  check_materials(scene, file, out);
  check_space(scene.space, file, out);
  const auto refuse = [&](const scene::Mark& mark, const std::string& what, const std::string& name) {
    out.push_back(
        fmt::format("{}: error: {} {}: time.solver: projection knows liquids between walls and colliders, "
                    "emitters and sinks{}",
                    place(file, mark), what, name, remedy));
  };
  for (const scene::Collider& c : scene.colliders)
    if (c.pin || c.rigid || c.holds || c.sticky > 0 || c.type == WallType::stick)
      refuse(c.mark, c.pin ? "pin" : c.rigid ? "rigid body" : "collider that holds or sticks,", c.name);
  for (const scene::Probe& p : scene.probes)
    std::visit(
        [&]<class P>(const P&) {
          if (P::type == "pressure" || P::type == "force") refuse(p.mark, "probe of " + std::string(P::type), p.name);
        },
        p.form);
  if (scene.time.damping > 0) refuse({}, "time.damping", fmt::format("{}", scene.time.damping));
  return out;
}

}  // namespace dreampm
