#include "dreampm/scene.h"

#include "dreampm/base/error.h"
#include "dreampm/physics/param.h"
#include "dreampm/scene/check.h"
#include "dreampm/scene/emit.h"
#include "dreampm/setup/projection_checks.h"
#include "dreampm/simulation/scene_access.h"

namespace dreampm {

struct Scene::Data {
  model::Scene model;
  std::string file;
};

Scene SceneAccess::make(model::Scene checked, std::string file) {
  return Scene(std::make_shared<const Scene::Data>(Scene::Data{std::move(checked), std::move(file)}));
}

namespace {

scene::ParseOptions parse_options(const SceneOptions& options) {
  scene::ParseOptions o;
  o.variant = options.variant;
  o.overrides = options.set;
  o.overrides_from = "set ";
  return o;
}

[[noreturn]] void refuse(const scene::ParseResult& result) {
  std::string text = result.text();
  if (text.ends_with('\n')) text.pop_back();
  throw InputError(text);
}

Scene checked(scene::ParseResult result, const std::string& file, std::vector<std::string>* warnings) {
  if (!result.ok()) refuse(result);
  if (warnings)
    for (const scene::Problem& p : result.problems) warnings->push_back(p.text());
  return SceneAccess::make(std::move(result.scene), file);
}

}  // namespace

Scene::Scene(dreampm::model::Scene model, std::string file) {
  scene::ParseResult result = scene::check_scene(model);
  if (file.empty()) file = model.name;
  for (scene::Problem& p : result.problems) p.file = file;
  if (!result.ok()) refuse(result);
  data_ = std::make_shared<const Data>(Data{std::move(result.scene), std::move(file)});
}

const std::string& Scene::name() const { return data_->model.name; }
const std::string& Scene::file() const { return data_->file; }
Vec3d Scene::min() const { return data_->model.space.min; }
Vec3d Scene::max() const { return data_->model.space.end(); }
double Scene::spacing() const { return data_->model.space.spacing; }
double Scene::fps() const { return data_->model.time.fps; }
int Scene::frames() const { return data_->model.time.frames; }

std::vector<std::string> Scene::materials() const {
  std::vector<std::string> names;
  for (const auto& m : data_->model.materials) names.push_back(m.name);
  return names;
}

std::string Scene::yaml() const { return scene::write_scene(data_->model); }

Scene Scene::with(const std::vector<std::string>& set) const { return parse_scene(yaml(), file(), {"", set}); }

const model::Scene& Scene::model() const { return data_->model; }

std::vector<std::string> check(const model::Scene& model) {
  std::vector<std::string> lines;
  for (const scene::Problem& p : scene::check_scene(model).problems)
    if (!p.warning) lines.push_back(p.message);
  return lines;
}

Shape parse_shape(std::string_view yaml, const std::string& name) { return scene::parse_shape_text(yaml, name); }
std::string shape_yaml(const Shape& shape) { return scene::shape_text(shape); }
model::Material parse_material(std::string_view yaml, const std::string& name) {
  model::Material material = scene::parse_material_text(yaml, name);
  material.name = name;
  return material;
}

std::string about_key(std::string_view path) { return scene::meaning_of(path); }

Values preset(std::string_view type, std::string_view name) {
  std::vector<std::string> types, names;
  for (const MaterialInfo& m : material_infos()) types.emplace_back(m.name);
  const MaterialInfo* info = find_material(type);
  if (!info) fail_input("no material of type '{}'{}", type, scene::suggest(type, types));
  for (const Preset& p : info->presets) {
    names.emplace_back(p.name);
    if (p.name != name) continue;
    Values values;
    for (const Preset::Value& v : p.values) values.set(v.key, v.value);
    return values;
  }
  fail_input("{} has no preset '{}'{}", type, name, scene::suggest(name, names));
}
model::Look parse_look(std::string_view yaml, const std::string& name) { return scene::parse_look_text(yaml, name); }

std::vector<std::string> refused_parts(const Scene& scene) { return projection_refusals(scene.model(), scene.file()); }

std::vector<std::string> refused_parts(const model::Scene& model) { return projection_refusals(model, model.name); }

Scene load_scene(const std::filesystem::path& file, const SceneOptions& options, std::vector<std::string>* warnings) {
  return checked(scene::parse_scene(file, parse_options(options)), file.string(), warnings);
}

Scene parse_scene(std::string_view yaml, const std::string& name, const SceneOptions& options,
                  std::vector<std::string>* warnings) {
  return checked(scene::parse_scene_text(yaml, name, parse_options(options)), name, warnings);
}

}  // namespace dreampm
