#include "dreampm/scene/files.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"

namespace dreampm::scene {
namespace fs = std::filesystem;

void each_model(Shape& shape, const std::function<void(std::string&)>& each) {
  if (MeshShape* m = std::get_if<MeshShape>(&shape.form)) each(m->path);
  if (PointsShape* p = std::get_if<PointsShape>(&shape.form)) each(p->path);
  if (BooleanShape* b = std::get_if<BooleanShape>(&shape.form))
    for (Shape& part : b->parts) each_model(part, each);
}

void each_model(SceneDescription& scene, const std::function<void(std::string&)>& each) {
  for (Body& b : scene.bodies) each_model(b.shape, each);
  for (Collider& c : scene.colliders) each_model(c.shape, each);
  for (Probe& p : scene.probes)
    if (RegionProbe* region = std::get_if<RegionProbe>(&p.form)) each_model(region->shape, each);
}

std::vector<fs::path> model_files(const fs::path& model) {
  std::vector<fs::path> files{model};
  std::string extension = model.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".gltf") return files;
  // One that is broken, or lays its keys otherwise, is refused where it is read as a mesh.
  const auto json = nlohmann::json::parse(read_file(model), nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return files;
  for (const auto& buffer : json["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const std::string uri = buffer["uri"].get<std::string>();
    if (!uri.starts_with("data:")) files.push_back(model.parent_path() / uri);
  }
  return files;
}

std::string model_hash(const fs::path& model) {
  Hash64 hash;
  for (const fs::path& file : model_files(model)) hash.add(std::string_view(read_file(file)));
  return hash.hex();
}

}  // namespace dreampm::scene
