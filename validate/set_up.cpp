#include "validate/set_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "dreampm/physics/materials.h"

namespace dreampm::validate {
namespace {

const char* name_of(Pattern pattern) {
  switch (pattern) {
    case Pattern::jitter:
      return "jittered";
    case Pattern::lattice:
      return "on a lattice";
    default:
      return "at Poisson-disk points";
  }
}

std::string text_of(const Wall& wall, bool periodic) {
  if (periodic) return "periodic";
  std::string s = wall.type == WallType::separate ? "separate"
                  : wall.type == WallType::slip   ? "slip"
                  : wall.type == WallType::stick  ? "stick"
                                                  : "are open";
  if (wall.friction > 0) s += fmt::format(" with friction {:.3g}", wall.friction);
  if (wall.skin_friction) s += " with skin friction";
  return s;
}

/// "floor, x_min slip with skin friction; the others slip": walls that do the same stand together,
/// most of them last.
std::string walls_of(const model::Space& space) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (std::size_t i = 0; i < space.walls.size(); ++i) {
    const std::string text = text_of(space.walls[i], space.periodic[i / 2]);
    const std::string name(i == index(Side::y_min) ? "floor" : i == index(Side::y_max) ? "ceiling" : side_names[i]);
    auto it = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == text; });
    if (it == groups.end()) it = groups.insert(groups.end(), {text, {}});
    it->second.push_back(name);
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  if (groups.size() == 1) return "walls " + groups[0].first;
  std::string s = "walls: ";
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const bool last = g + 1 == groups.size();
    if (last)
      s += "the others";
    else
      for (std::size_t k = 0; k < groups[g].second.size(); ++k) s += (k ? ", " : "") + groups[g].second[k];
    s += " " + groups[g].first + (last ? "" : "; ");
  }
  return s;
}

}  // namespace

std::string set_up_of(const model::Scene& scene, const World<double>& start) {
  const model::Space& space = scene.space;
  std::string s;
  const bool projected = scene.time.solver == SolverKind::projection;
  for (const model::Body& body : scene.bodies) {
    const auto& set = start.sets[index_of(scene.materials, body.material)];
    const double sound = facts_of(*find_material(set.material), set.values).sound_speed;
    s += fmt::format("{} ({}{}) {}, ", body.name, set.material,
                     projected ? "" : fmt::format(", sound {:.3g} m/s", sound), name_of(body.pattern));
  }
  for (const model::Collider& c : scene.colliders)
    if (c.rigid)
      s += c.rigid->density ? fmt::format("{} (rigid, {:.4g} kg/m^3), ", c.name, *c.rigid->density)
                            : fmt::format("{} (rigid, {:.4g} kg), ", c.name, c.rigid->mass.value_or(0));
  const Vec3i n = space.cells();
  s += fmt::format("{:.4g} particles a cell; {} x {} x {} cells of {:.4g} m; {}", space.particles_per_cell, n.x, n.y,
                   n.z, space.dx(), walls_of(space));
  if (projected) s += "; by the projection";
  return s + (scene.time.dt ? fmt::format("; steps of {:.3g} s", *scene.time.dt)
                            : fmt::format("; cfl {:.3g}", scene.time.cfl));
}

}  // namespace dreampm::validate
