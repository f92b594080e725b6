#include "dreampm/scene/parse.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/scene/sections.h"
#include "dreampm/version.h"

namespace dreampm::scene {
namespace {

std::vector<std::string> own_keys() { return {"dreampm", "variants"}; }

/// False if the scene is of a version that cannot be read.
bool check_version(Problems& problems, const YamlNode& root) {
  const YamlNode* v = root.find("dreampm");
  if (!v) {
    problems.error(root.at, fmt::format("missing key 'dreampm': a scene starts with 'dreampm: {}'", format_version));
    return true;
  }
  const auto n = read_count(problems, *v, "dreampm", 1, std::numeric_limits<std::int64_t>::max());
  if (n && *n > format_version) {
    problems.error(v->at, fmt::format("dreampm is {}: DreaMPM {} reads formats up to {}", *n, version, format_version));
    return false;
  }
  if (root.entries.front().key != "dreampm") {
    const auto at =
        std::find_if(root.entries.begin(), root.entries.end(), [](const Entry& e) { return e.key == "dreampm"; })->at;
    problems.error(at, "dreampm must be the first key");
  }
  return true;
}

void warn_unused(Reading& in, const YamlNode& root, const model::Scene& scene) {
  if (!scene.start.empty()) return;  // what there is of them stands in that file
  std::set<std::string> used;
  for (const Body& b : scene.bodies) used.insert(b.material);
  for (const Emitter& e : scene.emitters) used.insert(e.material);
  const YamlNode* map = root.find("materials");
  for (const Entry& e : map->entries)
    if (!used.contains(e.key))
      in.problems.warning(e.at, fmt::format("materials.{}: no body or emitter is made of it", e.key));
}

/// The mesh's grid goes with the particles, so what fits in cells depends on how many are in one.
void check_voxel(Reading& in, const YamlNode& root, const model::Scene& scene) {
  const double per_dx = std::cbrt(scene.space.particles_per_cell), voxel = scene.surface.voxel * per_dx;
  if (voxel >= 0.125 && voxel <= 2 * (1 + 1e-12)) return;
  const YamlNode* surface = root.find("surface");
  const YamlNode* at = find_in(surface, "voxel");
  in.problems.error(at ? at->at : root.find("space")->at,
                    fmt::format("surface.voxel is {}: must be between {:.4g} and {:.4g} dx, an eighth of the spacing "
                                "to twice it",
                                scene.surface.voxel, 0.125 / per_dx, 2 / per_dx));
}

}  // namespace

model::Scene read_scene(Reading& in, const YamlNode& root, const std::string& variant) {
  model::Scene scene;
  if (!root.is_map()) {
    expect_map(in.problems, root, "the scene");
    return scene;
  }
  read_map(in, root, "", scene_schema(), scene, own_keys());
  check_cuts(in, root.find("bodies"), scene);
  finish_light(root.find("render"), scene.render);
  read_looks(in, root, scene);
  check_shutter(in, root.find("render"), scene);
  check_foam(in, root.find("foam"), scene);
  if (scene.output.folder.empty())
    scene.output.folder = fmt::format("out/{}{}{}", scene.name, variant.empty() ? "" : "-", variant);
  if (in.problems.errors() == 0) check_voxel(in, root, scene);
  if (in.problems.errors() == 0) warn_unused(in, root, scene);
  scene.marks = std::move(in.marks);
  return scene;
}

namespace {

/// Checks the keys that a variant may not hold; its other keys are checked with the scene that it
/// changes.
void check_variants(Reading& in, const YamlNode& variants) {
  read_named(in, variants, "variants", [&](const Entry& e, const std::string& path) {
    if (!expect_map(in.problems, e.value, path)) return;
    for (const Entry& key : e.value.entries)
      if (key.key == "dreampm" || key.key == "variants")
        in.problems.error(key.at, fmt::format("{}.{}: a variant cannot change this", path, key.key));
  });
}

/// Adds the errors of the scene with that variant that are not known yet.
void check_with(Reading& in, const YamlNode& base, const Entry* variant) {
  YamlNode root = base;
  if (variant) merge(root, variant->value);
  Problems found;
  Reading inner{found, in.folder, in.assets, in.models, {}};
  read_scene(inner, root, variant ? variant->key : "");
  const std::vector<Problem> before = in.problems.list();
  for (const Problem& p : found.list())
    if (!p.warning && std::find(before.begin(), before.end(), p) == before.end())
      in.problems.error({p.file, p.line, p.column},
                        variant ? fmt::format("{} (variant {})", p.message, variant->key) : p.message);
}

std::size_t count_values(const YamlNode& node) {
  std::size_t n = 1;
  for (const YamlNode& i : node.items) n += count_values(i);
  for (const Entry& e : node.entries) n += count_values(e.value);
  return n;
}

/// Each variant is checked with all values of the scene.
bool can_be_checked(Problems& problems, const YamlNode& base, std::size_t variants) {
  constexpr std::size_t most = 5000000;
  const std::size_t values = count_values(base);
  if (variants <= most / values) return true;
  problems.error(base.find("variants")->at,
                 fmt::format("{} variants of {} values are more than can be checked", variants, values));
  return false;
}

/// Returns the problems by place; those without one come first. Problems of one place keep their
/// order.
std::vector<Problem> sorted(const std::vector<Problem>& list) {
  const auto before = [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  };
  std::vector<Problem> out;
  for (const Problem& p : list) out.insert(std::upper_bound(out.begin(), out.end(), p, before), p);
  return out;
}

ParseResult parse(std::string_view text, const std::string& file, const ParseOptions& options) {
  ParseResult result;
  Problems problems;
  Reading in{problems,
             std::filesystem::path(file).parent_path().string(),
             options.assets,
             options.of_run ? Reading::Models::in_folder : Reading::Models::looked_for,
             {}};
  const YamlNode base = read_yaml(text, file, problems);
  const auto done = [&] {
    result.problems = sorted(problems.list());
    return result;
  };
  if (!base.is_map()) {
    if (problems.errors() == 0) expect_map(problems, base, "the scene");
    return done();
  }
  if (!check_version(problems, base)) return done();

  const Entry* chosen = nullptr;
  const YamlNode* variants = base.find("variants");
  if (variants && variants->is_map() && !can_be_checked(problems, base, variants->entries.size())) return done();
  if (variants) check_variants(in, *variants);
  if (variants && variants->is_map())
    for (const Entry& e : variants->entries) {
      result.variants.push_back(e.key);
      if (e.key == options.variant && e.value.is_map()) chosen = &e;
    }
  if (!options.variant.empty() && !chosen) {
    problems.error({file, 0, 0},
                   fmt::format("no variant '{}'{}", options.variant, suggest(options.variant, result.variants)));
    return done();
  }

  YamlNode root = base;
  if (chosen) merge(root, chosen->value);
  for (const std::string& o : options.overrides) {
    const YamlNode over = read_override(o, options.overrides_from, problems);
    for (const std::string& k : own_keys())
      if (const YamlNode* n = over.find(k)) problems.error(n->at, fmt::format("{} cannot be set", k));
    merge(root, over);
  }
  result.scene = read_scene(in, root, options.variant);
  if (options.overrides.empty()) {
    if (chosen) check_with(in, base, nullptr);
    for (std::size_t i = 0; i < result.variants.size(); ++i)
      if (const Entry& e = variants->entries[i]; &e != chosen && e.value.is_map()) check_with(in, base, &e);
  }
  return done();
}

}  // namespace

bool ParseResult::ok() const {
  return std::all_of(problems.begin(), problems.end(), [](const Problem& p) { return p.warning; });
}

std::string ParseResult::text() const {
  std::string all;
  for (const Problem& p : problems) all += p.text() + "\n";
  return all;
}

ParseResult parse_scene_text(std::string_view text, const std::string& file, const ParseOptions& options) {
  return parse(text, file, options);
}

ParseResult parse_scene(const std::filesystem::path& path, const ParseOptions& options) {
  std::string text;
  try {
    text = read_file(path);
  } catch (const InputError& e) {
    ParseResult result;
    result.problems.push_back({path.string(), 0, 0, e.what()});
    return result;
  }
  return parse(text, path.string(), options);
}

model::Scene load_scene(const std::filesystem::path& path, const ParseOptions& options,
                        std::vector<Problem>* warnings) {
  ParseResult result = parse_scene(path, options);
  std::string errors;
  for (const Problem& p : result.problems) {
    if (p.warning) {
      if (warnings) warnings->push_back(p);
    } else {
      if (!errors.empty()) errors += "\n";
      errors += p.text();
    }
  }
  if (!errors.empty()) throw InputError(errors);
  return std::move(result.scene);
}

}  // namespace dreampm::scene
