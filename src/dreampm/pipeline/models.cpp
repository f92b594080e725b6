#include "dreampm/pipeline/models.h"

#include <map>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/import/asset.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/files.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr const char* models = "models";

/// models/HASH/NAME of every model file, by its path.
std::map<std::string, fs::path> kept_names(model::Scene scene) {
  std::map<std::string, fs::path> names;
  scene::each_model(scene, [&](std::string& path) {
    if (is_asset(path) || names.contains(path)) return;
    names[path] = fs::path(models) / scene::model_hash(path) / fs::path(path).filename();
  });
  return names;
}

bool holds(const fs::path& file, const std::string& bytes) {
  return fs::is_regular_file(file) && read_file(file) == bytes;
}

/// The model and the files that it names, beside each other as they were.
void copy_model(const fs::path& from, const fs::path& to) {
  for (const fs::path& part : scene::model_files(from)) {
    const fs::path place = part.lexically_relative(from.parent_path().empty() ? "." : from.parent_path());
    const fs::path name = part == from ? from.filename() : place;
    // The copy names it by the same way, so that the way itself must stay inside.
    if (name.empty() || *name.lexically_normal().begin() == "..") {
      warn("{} names {}, which lies outside its folder: the run's folder keeps no copy of that", from.string(),
           part.string());
      continue;
    }
    const fs::path target = to.parent_path() / name;
    const std::string bytes = read_file(part);
    if (holds(target, bytes)) continue;
    make_folder(target.parent_path());
    replace_file_text(target, bytes);
  }
}

/// Copies of models that earlier scenes of the folder had.
void remove_others(const fs::path& folder, const std::set<std::string>& hashes) {
  if (!fs::is_directory(folder)) return;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_hash = name.size() == 16 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (is_hash && !hashes.contains(name)) old.push_back(entry.path());
  }
  for (const fs::path& path : old) fs::remove_all(path);
  if (fs::is_empty(folder)) fs::remove(folder);
}

}  // namespace

model::Scene with_kept_models(const model::Scene& scene) {
  const auto names = kept_names(scene);
  model::Scene kept = scene;
  scene::each_model(kept, [&](std::string& path) {
    if (const auto name = names.find(path); name != names.end()) path = name->second.string();
  });
  return kept;
}

model::Scene located_in(model::Scene kept, const fs::path& folder) {
  scene::each_model(kept, [&](std::string& path) {
    if (!is_asset(path)) path = (folder / path).lexically_normal().string();
  });
  return kept;
}

void write_portable_scene(const model::Scene& scene, const fs::path& file) {
  for (const auto& [path, name] : kept_names(scene)) copy_model(path, file.parent_path() / name);
  const std::string text = scene::write_scene(with_kept_models(scene));
  if (!holds(file, text)) replace_file_text(file, text);
}

void write_run_scene(const model::Scene& scene, const fs::path& folder) {
  write_portable_scene(scene, folder / "scene.yaml");
  std::set<std::string> hashes;
  for (const auto& [path, name] : kept_names(scene)) hashes.insert(name.parent_path().filename().string());
  remove_others(folder / models, hashes);
}

}  // namespace dreampm
