#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/play/model/open_file.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/report/report_config.h"

namespace dreampm::play {
namespace {

/// Of a story that the projection moves: how the explicit solver does, which takes fewer particles.
constexpr const char* explicit_variant = "explicit";
/// How the report's own settings are called in place of a file.
constexpr std::string_view report_name = "report";

PlayScene play_scene_of(const ReportConfig& config, std::size_t preset, const std::string& file) {
  Scene own = parse_scene(report_scene(config, preset), file);  // refuses a preset that there is not
  std::string name = fmt::format("{} {}", report_name, config.presets.at(preset).name);
  PlayScene scene{std::move(name), std::move(own), true, config.max_time_step, config.max_hard, file, {}, preset};
  for (const ReportPreset& p : config.presets) scene.presets.push_back(p.name);
  for (const ReportMaterial& m : config.materials) scene.opacity[report_material_name(m.id)] = m.color[3];
  scene.window = PlayScene::Window{config.width, config.height};
  return scene;
}

bool has_key(std::string_view text, std::string_view key) {
  return text.starts_with(key) || text.find(fmt::format("\n{}", key)) != std::string_view::npos;
}

}  // namespace

PlayScene load_play_scene(const std::string& name_or_file, std::size_t preset) {
  for (const Story& s : stories())
    if (s.name == name_or_file) {
      const std::string file = std::string(s.name) + ".yaml";
      PlayScene scene{std::string(s.name), parse_scene(s.scene, file)};
      if (has_key(s.scene, std::string("  ") + explicit_variant + ":"))
        scene.other = parse_scene(s.scene, file, {explicit_variant, {}});
      return scene;
    }
  if (name_or_file == report_name) return play_scene_of(report_config(), preset, name_or_file);
  if (!std::filesystem::exists(name_or_file)) {
    std::string names{report_name};
    for (const Story& s : stories()) names += fmt::format(", {}", s.name);
    throw InputError(fmt::format("there is no story and no file {}; stories: {}", name_or_file, names));
  }
  if (kind_of_file(name_or_file) == FileKind::mesh) {
    const std::filesystem::path mesh = name_or_file;
    return {mesh.stem().string(), parse_scene(scene_of_mesh(mesh), mesh.string())};
  }
  if (kind_of_file(name_or_file) == FileKind::record)
    throw InputError(fmt::format("{} is a record: drop it into a window, or dreampm play STORY --headless --script {}",
                                 name_or_file, name_or_file));
  if (const std::string text = read_file(name_or_file); has_key(text, "presets:") && !has_key(text, "dreampm:"))
    return play_scene_of(parse_report_config(text, name_or_file), preset, name_or_file);
  Scene scene = load_scene(name_or_file);
  std::string name = scene.name();
  return {std::move(name), std::move(scene)};
}

}  // namespace dreampm::play
