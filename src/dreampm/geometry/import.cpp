#include "dreampm/geometry/import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <optional>

#include "dreampm/base/error.h"
#include "dreampm/base/uri.h"
#include "dreampm/geometry/alike.h"
#include "dreampm/geometry/asset.h"
#include "dreampm/geometry/gltf.h"
#include "dreampm/geometry/gzip.h"
#include "dreampm/geometry/heightfield.h"
#include "dreampm/geometry/obj.h"
#include "dreampm/geometry/off.h"
#include "dreampm/geometry/ply_header.h"
#include "dreampm/geometry/point_file.h"
#include "dreampm/geometry/stl.h"

namespace dreampm {
namespace {

/// The model itself comes from memory, unpacked; what it names beside it from the disk, where the
/// names of buffers may be written as URIs.
class ModelFiles final : public Assimp::DefaultIOSystem {
 public:
  ModelFiles(const std::filesystem::path& model, std::string_view text)
      : model_(model.string()),
        folder_(model_.substr(0, model_.size() - model.filename().string().size())),
        text_(text) {}

  bool Exists(const char* file) const override {
    return file == model_ || DefaultIOSystem::Exists(found(file).c_str());
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (file != model_) return DefaultIOSystem::Open(found(file).c_str(), mode);
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
  }

 private:
  std::string found(const std::string& file) const {
    if (DefaultIOSystem::Exists(file.c_str()) || !file.starts_with(folder_)) return file;
    return folder_ + percent_decoded(std::string_view(file).substr(folder_.size()));
  }
  std::string model_, folder_;
  std::string_view text_;
};

std::size_t count_triangles(const aiScene& scene) {
  std::size_t count = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f) count += scene.mMeshes[m]->mFaces[f].mNumIndices == 3;
  return count;
}

/// `path` is that of the unpacked file, `name` that of the file itself, for messages.
Model from_gltf(const std::string& given, const std::filesystem::path& path, const std::string& name) {
  check_gltf(given, name);
  const std::string text = with_scene(given, name);
  Assimp::Importer importer;
  importer.SetIOHandler(new ModelFiles(path, text));  // which it owns
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                          aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                          aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                          aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                          aiComponent_CAMERAS | aiComponent_MATERIALS);
  const unsigned steps = aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType |
                         aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices;
  const std::optional<std::size_t> promised = gltf_triangles(text, name);
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  if (scene && promised)
    if (const std::size_t found = count_triangles(*scene); found < *promised)
      fail_input("{}: {} of {} triangles name vertices that are not there", name, *promised - found, *promised);
  if (scene) scene = importer.ApplyPostProcessing(steps);
  if (!scene) fail_input("{}: cannot be read as a mesh: {}", name, importer.GetErrorString());
  Model mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v)
      mesh.vertices.push_back({part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z});
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      for (int k = 0; k < 3; ++k)
        if (face.mIndices[k] >= part.mNumVertices)
          fail_input("{}: face {} names vertex {}, but there are {}", name, f, face.mIndices[k], part.mNumVertices);
      mesh.triangles.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  return mesh;
}

}  // namespace

Model read_model(const std::filesystem::path& path) {
  const std::string name = path.string(), text = read_unpacked(path);
  if (text.empty()) fail_input("{}: is empty, a mesh is wanted", name);
  const std::string kind = file_kind(path);
  Model model;
  if (is_point_kind(kind))
    model = parse_point_file(kind, text, name);
  else if (kind == ".off")
    model = parse_off(text, name);
  else if (kind == ".obj")
    model = parse_obj(text, name);
  else if (kind == ".stl")
    model = parse_stl(text, name);
  else if (kind == ".gltf" || kind == ".glb")
    model = from_gltf(text, unpacked_name(path), name);
  else
    fail_input("{}: files of kind \"{}\" are not read; {}, .obj, .stl, .gltf, .glb and .off are, also with .gz", name,
               kind, point_kinds());
  require_finite(model, name);
  if (model.vertices.empty()) fail_input("{}: holds neither vertices nor faces; a mesh is wanted", name);
  if (model.triangles.empty() && !is_point_kind(kind))
    fail_input("{}: has {} vertices but no faces; clouds of points are read from {}", name, model.vertices.size(),
               point_kinds());
  turn_alike_with_warnings(model, name);
  return model;
}

bool is_ply(const std::filesystem::path& path) { return file_kind(path) == ".ply"; }

std::optional<MovingCloud> read_if_cloud(const std::filesystem::path& path, double scale) {
  if (!is_point_kind(file_kind(path)) || (is_ply(path) && read_ply_header(path).has_faces())) return std::nullopt;
  Model model = read_point_file(path);
  if (!model.triangles.empty()) return std::nullopt;
  return moving_cloud(std::move(model), path.string(), scale);
}

Model import_mesh(const std::filesystem::path& path) {
  Model model = read_model(path);
  if (model.triangles.empty())
    fail_input("{}: has {} vertices but no faces; a scene takes a cloud of points by `points: FILE`", path.string(),
               model.vertices.size());
  return model;
}

Model mesh_of(const MeshShape& shape) {
  return shape.heights ? heightfield_model(shape.path, *shape.heights) : load_mesh(shape.path);
}

Model load_mesh(const std::string& name) { return is_asset(name) ? load_asset(name) : import_mesh(name); }
Model load_model(const std::string& name) { return is_asset(name) ? load_asset(name) : read_model(name); }

}  // namespace dreampm
