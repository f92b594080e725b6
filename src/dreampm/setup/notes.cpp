#include "dreampm/setup/notes.h"

#include <algorithm>
#include <optional>

#include "dreampm/physics/param.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/setup/body_checks.h"
#include "dreampm/setup/place.h"

namespace dreampm {
namespace {

/// A note where friction is set that nothing feels: liquids feel none.
std::optional<std::string> unfelt_friction(const model::Scene& scene, const std::string& file) {
  const auto is_liquid = [](const model::Material& m) { return info_of(m).liquid; };
  const auto& all = scene.materials;
  const auto is_body = [](const model::Collider& c) { return c.rigid.has_value(); };
  if (all.empty() || !std::all_of(all.begin(), all.end(), is_liquid) ||
      std::any_of(scene.colliders.begin(), scene.colliders.end(), is_body))
    return std::nullopt;
  constexpr const char* who =
      "is for solids and grains, and the scene has none; what liquids feel is stick, or a "
      "wall's skin_friction";
  for (const model::Collider& c : scene.colliders)
    if (c.friction > 0) return fmt::format("{}: the friction of collider {} {}", place(file, scene, c), c.name, who);
  for (std::size_t s = 0; s < 6; ++s)
    if (scene.space.walls[s].friction > 0)
      return fmt::format("{}: the friction of wall {} {}", file, side_names[s], who);
  return std::nullopt;
}

/// Cells across from which a body of a third of the liquid's density rises by apic with three
/// quarters of the acceleration that added mass gives it (docs/howto/transfers.md).
constexpr double wide_enough = 16;

/// A note on a light, small body in a liquid whose transfer takes a share of its motion in each
/// step.
std::optional<std::string> held_back(const model::Scene& scene, const std::string& file, const Meshes& meshes) {
  if (scene.time.solver == SolverKind::projection) return std::nullopt;  // bodies are in its pressure
  for (const model::Collider& c : scene.colliders) {
    if (!c.rigid || !c.rigid->density) continue;
    const Vec3d size = shape_bounds(c.shape, scene.space.spacing, meshes).size();
    const double cells = std::min({size.x, size.y, size.z}) / scene.space.dx();
    if (cells >= wide_enough) continue;
    for (const model::Material& m : scene.materials)
      if (info_of(m).liquid && m.transfer == Apic::name && *c.rigid->density < m.values["density"])
        return fmt::format(
            "{}: rigid body {} is lighter than {} and {:.1f} cells across: it rises too slowly by transfer: apic; "
            "asflip lets it rise, and a step takes a third longer",
            place(file, scene, c), c.name, m.name, cells);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> notes_on(const model::Scene& scene, const std::string& file, const Meshes& meshes) {
  std::vector<std::string> all;
  for (auto& note : {unfelt_friction(scene, file), held_back(scene, file, meshes)})
    if (note) all.push_back(*note);
  return all;
}

}  // namespace dreampm
