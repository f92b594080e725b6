#include "validate/validation_run.h"

#include "dreampm/backend/registry.h"
#include "dreampm/scene/parse.h"
#include "validate/built_in.h"

namespace dreampm::validate {
namespace {

std::string text_of(const std::string& name) {
  for (const BuiltIn& file : built_in_files())
    if (file.name == name) {
      std::string text;
      for (const std::string_view part : file.parts) text += part;
      return text;
    }
  fail_input("scenes/validation/{}: is not built in", name);
}

}  // namespace

std::unique_ptr<Backend<float>> float_backend(const Options& options) {
  AnyBackend made = dreampm::make_backend(options.backend);
  if (auto* in_float = std::get_if<std::unique_ptr<Backend<float>>>(&made)) return std::move(*in_float);
  fail_input(
      "validate: the backend {} computes in double; what is chosen is that of the runs in float, and cases "
      "that look at double have it",
      options.backend);
}

std::string scene_text(std::string_view name) { return text_of(std::string(name) + ".yaml"); }

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const BuiltIn& file : built_in_files())
    if (file.name.ends_with(".yaml")) names.emplace_back(file.name.substr(0, file.name.size() - 5));
  return names;
}

Table reference_table(std::string_view name) {
  const std::string file = "data/" + std::string(name);
  return Table(text_of(file), "scenes/validation/" + file);
}

std::vector<std::string> by_projection(std::string_view body, const std::vector<std::string>& more) {
  std::vector<std::string> all{"time.solver=projection", fmt::format("bodies.{}.sample={{pattern: jitter}}", body)};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

model::Scene built_in_scene(std::string_view name, const std::vector<std::string>& overrides) {
  const std::string file = "scenes/validation/" + std::string(name) + ".yaml";
  scene::ParseResult result =
      scene::parse_scene_text(scene_text(name), file, {.variant = {}, .overrides = overrides, .assets = {}});
  if (!result.ok()) throw InputError(result.text());
  return std::move(result.scene);
}

}  // namespace dreampm::validate
