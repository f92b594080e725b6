#include "dreampm/scene/files.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/hash.h"
#include "dreampm/base/uri.h"
#include "dreampm/import/gzip.h"

namespace dreampm::scene {
namespace fs = std::filesystem;
namespace {

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_gltf(const fs::path& model) {
  const bool packed = lower_extension(model) == ".gz";
  return lower_extension(packed ? model.stem() : model) == ".gltf";
}

}  // namespace

void each_model(Shape& shape, const std::function<void(std::string&)>& each) {
  if (MeshShape* m = std::get_if<MeshShape>(&shape.form)) each(m->path);
  if (PointsShape* p = std::get_if<PointsShape>(&shape.form)) each(p->path);
  if (BooleanShape* b = std::get_if<BooleanShape>(&shape.form))
    for (Shape& part : b->parts) each_model(part, each);
  if (ContainerShape* c = std::get_if<ContainerShape>(&shape.form))
    for (Shape& hollow : c->hollow) each_model(hollow, each);
}

void each_model(model::Scene& scene, const std::function<void(std::string&)>& each) {
  if (!scene.start.empty()) each(scene.start);
  for (model::Body& b : scene.bodies) each_model(b.shape, each);
  for (model::Collider& c : scene.colliders) {
    each_model(c.shape, each);
    if (c.sequence)
      for (std::string& file : c.sequence->files) each(file);
  }
  for (model::Emitter& e : scene.emitters) each_model(e.shape, each);
  for (model::Sink& s : scene.sinks) each_model(s.shape, each);
  for (model::Probe& p : scene.probes)
    if (RegionProbe* region = std::get_if<RegionProbe>(&p.form)) each_model(region->shape, each);
  if (!scene.render.light.environment.empty()) each(scene.render.light.environment);
}

std::vector<fs::path> model_files(const fs::path& model) {
  std::vector<fs::path> files{model};
  if (!is_gltf(model)) return files;
  // One that is broken, or lays its keys otherwise, is refused where it is read as a mesh.
  const auto json = nlohmann::json::parse(read_unpacked(model), nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return files;
  for (const auto& buffer : json["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const std::string uri = buffer["uri"].get<std::string>();
    if (uri.starts_with("data:")) continue;
    // The URI as written and decoded: a file may be called what others would write as an escape.
    const fs::path as_written = model.parent_path() / uri, decoded = model.parent_path() / percent_decoded(uri);
    files.push_back(fs::is_regular_file(as_written) ? as_written : decoded);
    if (!fs::is_regular_file(files.back())) fail_input("{}: its buffer \"{}\" is not there", model.string(), uri);
  }
  return files;
}

std::string model_hash(const fs::path& model) {
  Hash64 hash;
  for (const fs::path& file : model_files(model)) hash.add(std::string_view(read_file(file)));
  return hash.hex();
}

}  // namespace dreampm::scene
