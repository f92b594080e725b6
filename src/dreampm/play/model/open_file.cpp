#include "dreampm/play/model/open_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "dreampm/error.h"

namespace dreampm::play {
namespace {

constexpr std::array<std::string_view, 10> meshes{".obj", ".ply", ".stl", ".off", ".gltf",
                                                  ".glb", ".vtk", ".vtp", ".vtu", ".bgeo"};
constexpr std::size_t most_files = 200;

std::string ending(std::filesystem::path file) {
  std::string text = file.extension().string();
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text == ".gz" ? ending(file.replace_extension()) : text;
}

/// A record begins with the version that wrote it, and the story that it is of: one word, or one in
/// quotes.
bool is_record(const std::filesystem::path& file) {
  std::ifstream text(file);
  std::string line;
  for (int n = 0; n < 2 && std::getline(text, line); ++n)
    if (line.starts_with("plays ") && (line[6] == '"' || line.find(' ', 6) == std::string::npos)) return true;
  return false;
}

}  // namespace

FileKind kind_of_file(const std::filesystem::path& file) {
  const std::string end = ending(file);
  if (end == ".yaml" || end == ".yml") return FileKind::scene;
  if (std::ranges::find(meshes, end) != meshes.end()) return FileKind::mesh;
  return is_record(file) ? FileKind::record : FileKind::other;
}

Action opening(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(fmt::format("{}: there is no such file", file.string()));
  switch (kind_of_file(file)) {
    case FileKind::scene:
    case FileKind::mesh:
      return {"open", {file.string()}};
    case FileKind::record:
      return {"replay", {file.string()}};
    case FileKind::other:
      break;
  }
  throw InputError(fmt::format(
      "{}: cannot be opened; scenes and configs (.yaml), records (--record) and meshes (.obj, .ply, .stl, ...) can",
      file.string()));
}

std::vector<std::string> files_to_open(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  std::size_t seen = 0;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end && seen < most_files;
       it.increment(error), ++seen) {
    const std::string kind = ending(it->path());
    // Text files are looked into.
    const bool may_be = kind == ".yaml" || kind == ".yml" || kind == ".txt" || kind == ".record" ||
                        std::ranges::find(meshes, kind) != meshes.end();
    if (may_be && it->is_regular_file(error) && kind_of_file(it->path()) != FileKind::other)
      names.push_back(it->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::string scene_of_mesh(const std::filesystem::path& file) {
  std::string quoted;
  for (const char c : std::filesystem::absolute(file).string()) quoted += c == '\'' ? "''" : std::string(1, c);
  std::string name;
  for (const char c : file.stem().string()) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
  return fmt::format(
      "dreampm: 1\n"
      "name: '{0}'\n"
      "about: {1}\n"
      "space: {{min: [0, 0, 0], max: [1.0, 0.9, 0.7], spacing: 0.015, walls: {{ceiling: {{type: open}}}}}}\n"
      "time: {{fps: 60}}\n"
      "materials: {{jelly: {{type: elastic, preset: jelly, youngs_modulus: 2.0e+4}}}}\n"
      "bodies: {{model: {{material: jelly, shape: {{mesh: '{2}', fit: {{longest: 0.42}}, center: [0.5, 0.34, "
      "0.35]}}}}}}\n"
      "render:\n"
      "  camera: {{from: [1.5, 0.9, 1.9], to: [0.5, 0.26, 0.35], fov: 32}}\n"
      "  looks: {{jelly: {{type: opaque, color: [0.80, 0.16, 0.28], roughness: 0.3}}}}\n",
      name, "a mesh that falls as jelly", quoted);
}

}  // namespace dreampm::play
