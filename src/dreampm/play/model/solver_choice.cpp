#include "dreampm/play/model/solver_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "dreampm/error.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/play/model/matter.h"

#include "dreampm/physics/param.h"

namespace dreampm::play {
namespace {

/// Of the way to an end of a slider, to where it may go.
constexpr int halvings = 24;

/// Parameters that make the stiffness of a liquid, which a projection has no use for.
constexpr std::array<std::string_view, 5> of_stiffness{"max_compression", "bulk_modulus", "gamma", "tension",
                                                       "relaxation"};

/// What a line of a check says, without where it is said of and what to write in the file.
std::string without_place(std::string line) {
  constexpr std::string_view error = "error: ", remedy = "; leave time.solver out";
  if (const std::size_t at = line.find(error); at != std::string::npos) line.erase(0, at + error.size());
  if (const std::size_t at = line.find(remedy); at != std::string::npos) line.erase(at);
  return line;
}

/// What the scene is refused for, first of list; empty: nothing.
std::string refusal(const model::Scene& scene) {
  const std::vector<std::string> lines = refused_parts(scene);
  return lines.empty() ? "" : without_place(lines.front());
}

/// A scene of the same space and steps that holds these materials alone.
model::Scene with_materials(const model::Scene& scene, std::vector<model::Material> materials) {
  model::Scene small;
  small.space = scene.space, small.time = scene.time;
  small.gravity = scene.gravity, small.gravity_keys = scene.gravity_keys;
  small.materials = std::move(materials);
  return small;
}

}  // namespace

const model::Scene& scene_of_kinds() {
  static const Scene one_of_each = [] {
    std::string text = "dreampm: 1\nname: kinds\nspace: {max: [1, 1, 1], spacing: 0.1}\nmaterials:\n";
    for (const Matter& m : matters()) text += fmt::format("  {}: {}\n", m.name, m.scene);
    text += fmt::format("bodies: {{one: {{material: {}, shape: {{box: {{min: [0, 0, 0], max: [1, 1, 1]}}}}}}}}\n",
                        matters().front().name);
    text += "render:\n  looks:\n";
    for (const Matter& m : matters()) text += fmt::format("    {}: {}\n", m.name, m.look);
    return parse_scene(text, "kinds.yaml");
  }();
  return one_of_each.model();
}

namespace {

std::vector<std::string> settings_of(SolverKind solver) {
  const bool projects = solver == SolverKind::projection;
  return {fmt::format("time.solver={}", solver_names().at(static_cast<std::size_t>(solver))),
          fmt::format("time.cfl={}", projects ? usual_projection_cfl : model::Time{}.cfl)};
}

}  // namespace

const std::vector<std::string>& solver_names() {
  static const std::vector<std::string> names{"explicit", "projection"};
  return names;
}
bool is_projection(const model::Scene& scene) { return scene.time.solver == SolverKind::projection; }

std::string why_not_other(const PlayScene& scene) {
  if (scene.report) return "the report has steps of its own";
  const model::Scene& model = scene.scene.model();
  if (!model.start.empty()) return fmt::format("{} starts from a moment of one solver", scene.name);
  if (scene.other || is_projection(model)) return "";
  model::Scene with = model;
  with.time.solver = SolverKind::projection, with.time.cfl = usual_projection_cfl;
  return refusal(with);
}

PlayScene by_solver(PlayScene scene, SolverKind solver) {
  if (scene.scene.model().time.solver == solver) return scene;
  if (const std::string why = why_not_other(scene); !why.empty()) throw InputError("solver: " + why);
  if (!scene.other) {
    scene.scene = scene.scene.with(settings_of(solver));
    return scene;
  }
  // What is kept is of medium size.
  PlayScene kept = scene;
  kept.other.reset();
  const std::size_t size = std::exchange(scene.size, medium_size);
  scene.scene = std::move(*scene.other);
  scene.other = resized(std::move(kept), medium_size).scene;
  return resized(std::move(scene), size);
}

std::vector<std::string> matter_refusals(const model::Scene& scene) {
  std::vector<std::string> list(matters().size());
  if (!is_projection(scene) || scene.materials.empty()) return list;
  for (std::size_t kind = 0; kind < list.size(); ++kind) {
    const model::Material& m = scene_of_kinds().materials.at(kind);
    if (std::any_of(scene.materials.begin(), scene.materials.end(),
                    [&](const auto& own) { return own.name == m.name; }))
      continue;
    list[kind] = refusal(with_materials(scene, {scene.materials.front(), m}));
  }
  return list;
}

std::optional<Liquid> other_liquid(const model::Scene& scene, std::size_t kind) {
  const model::Scene& all = scene_of_kinds();
  const model::Material& m = all.materials.at(kind);
  if (!is_projection(scene) || scene.materials.size() != 1 || m.type != "newtonian") return std::nullopt;
  return Liquid{m.values["density"], m.values["viscosity"], all.render.looks.at(m.name)};
}

double allowed_end(const model::Scene& scene, const model::Material& material, const std::string& key, double end) {
  if (!is_projection(scene)) return end;
  const auto is_allowed = [&](double value) {
    std::vector<model::Material> materials = scene.materials;
    for (model::Material& m : materials)
      if (m.name == material.name) m.values.set(key, value);
    return refusal(with_materials(scene, std::move(materials))).empty();
  };
  if (is_allowed(end)) return end;
  double in = material.values[key], out = end;
  for (int n = 0; n < halvings; ++n) {
    const double middle = in > 0 && out > 0 ? std::sqrt(in * out) : 0.5 * (in + out);
    (is_allowed(middle) ? in : out) = middle;
  }
  return in;
}

bool has_effect(const model::Scene& scene, const model::Material& material, std::string_view key) {
  return !is_projection(scene) || !info_of(material).liquid ||
         std::find(of_stiffness.begin(), of_stiffness.end(), key) == of_stiffness.end();
}

}  // namespace dreampm::play
