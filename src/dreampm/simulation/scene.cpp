#include "dreampm/scene.h"

#include "dreampm/base/error.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/projection_checks.h"

namespace dreampm {

struct Scene::Data {
  SceneDescription description;
  std::string file;
};

namespace {

scene::ParseOptions parse_options(const SceneOptions& options) {
  scene::ParseOptions o;
  o.variant = options.variant;
  o.overrides = options.set;
  o.overrides_from = "set ";
  return o;
}

Scene checked(scene::ParseResult result, const std::string& file, std::vector<std::string>* warnings) {
  if (!result.ok()) {
    std::string text = result.text();
    if (text.ends_with('\n')) text.pop_back();
    throw InputError(text);
  }
  if (warnings)
    for (const scene::Problem& p : result.problems) warnings->push_back(p.text());
  return Scene(std::move(result.scene), file);
}

}  // namespace

Scene::Scene(SceneDescription description, std::string file)
    : data_(std::make_shared<const Data>(Data{std::move(description), std::move(file)})) {}

const std::string& Scene::name() const { return data_->description.name; }
const std::string& Scene::file() const { return data_->file; }
Vec3d Scene::min() const { return data_->description.space.min; }
Vec3d Scene::max() const { return data_->description.space.max; }
double Scene::spacing() const { return data_->description.space.spacing; }
double Scene::fps() const { return data_->description.time.fps; }
int Scene::frames() const { return data_->description.time.frames; }

std::vector<std::string> Scene::materials() const {
  std::vector<std::string> names;
  for (const scene::Material& m : data_->description.materials) names.push_back(m.name);
  return names;
}

std::string Scene::yaml() const { return scene::emit_scene(data_->description); }

Scene Scene::with(const std::vector<std::string>& set) const { return parse_scene(yaml(), file(), {"", set}); }

const SceneDescription& Scene::description() const { return data_->description; }

std::vector<std::string> refused_parts(const Scene& scene) {
  return projection_refusals(scene.description(), scene.file());
}

Scene load_scene(const std::filesystem::path& file, const SceneOptions& options, std::vector<std::string>* warnings) {
  return checked(scene::parse_scene(file, parse_options(options)), file.string(), warnings);
}

Scene parse_scene(std::string_view yaml, const std::string& name, const SceneOptions& options,
                  std::vector<std::string>* warnings) {
  return checked(scene::parse_scene_text(yaml, name, parse_options(options)), name, warnings);
}

}  // namespace dreampm
