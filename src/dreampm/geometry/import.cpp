#include "dreampm/geometry/import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstring>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/geometry/asset.h"
#include "dreampm/geometry/gltf.h"
#include "dreampm/geometry/gzip.h"
#include "dreampm/geometry/off.h"
#include "dreampm/geometry/ply.h"

namespace dreampm {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

TriMesh from_ply(std::string_view text, const std::string& name) {
  PlyContent content = parse_ply(text, name, true);
  TriMesh mesh;
  mesh.vertices.reserve(content.vertices.size());
  for (const Vec3d& v : content.vertices) mesh.vertices.push_back(Vec3f(v));
  mesh.triangles = std::move(content.triangles);
  return mesh;
}

/// A binary STL says how many triangles of 50 bytes follow; an ASCII one starts with "solid" and ends with "endsolid".
void check_stl(std::string_view text, const std::string& name) {
  std::uint32_t count = 0;
  if (text.size() >= 84) std::memcpy(&count, text.data() + 80, 4);
  if (text.size() >= 84 && 84 + 50 * std::uint64_t(count) == text.size()) return;
  if (text.starts_with("solid") && text.find("facet") != std::string_view::npos) {
    if (text.find("endsolid") == std::string_view::npos) fail_input("{}: is cut short: it has no endsolid", name);
    return;
  }
  if (text.size() < 84) fail_input("{}: is no STL file, or is cut short: {} bytes", name, text.size());
  fail_input("{}: promises {} triangles, which take {} bytes, but it has {}; it is cut short, or no STL file", name,
             count, 84 + 50 * std::uint64_t(count), text.size());
}

std::size_t count_triangles(const aiScene& scene) {
  std::size_t count = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f) count += scene.mMeshes[m]->mFaces[f].mNumIndices == 3;
  return count;
}

TriMesh from_assimp(std::string_view text, const std::filesystem::path& path, const std::string& kind, bool unpacked) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                          aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                          aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                          aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                          aiComponent_CAMERAS | aiComponent_MATERIALS);
  const unsigned steps = aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType |
                         aiProcess_PreTransformVertices | aiProcess_JoinIdenticalVertices;
  const bool gltf = kind == "gltf" || kind == "glb";
  const std::optional<std::size_t> promised = gltf ? gltf_triangles(text, path.string()) : std::nullopt;
  // From the file itself where possible, since glTF names further files beside it.
  const aiScene* scene = unpacked ? importer.ReadFileFromMemory(text.data(), text.size(), 0, kind.c_str())
                                  : importer.ReadFile(path.string(), 0);
  if (scene && promised)
    if (const std::size_t found = count_triangles(*scene); found < *promised)
      fail_input("{}: {} of {} triangles name vertices that are not there", path.string(), *promised - found,
                 *promised);
  if (scene) scene = importer.ApplyPostProcessing(steps);
  if (!scene) fail_input("{}: cannot be read as a mesh: {}", path.string(), importer.GetErrorString());
  TriMesh mesh;
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
          fail_input("{}: face {} names vertex {}, but there are {}", path.string(), f, face.mIndices[k],
                     part.mNumVertices);
      mesh.triangles.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  return mesh;
}

}  // namespace

TriMesh import_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::string text = read_file(path);
  if (text.empty()) fail_input("{}: is empty, a mesh is wanted", name);
  std::filesystem::path inner = path;
  if (lower(inner.extension().string()) == ".gz") inner.replace_extension();
  const bool packed = is_gzip(text);
  if (packed) text = unpack_gzip(text, name);
  std::string kind = lower(inner.extension().string());
  if (!kind.empty()) kind.erase(0, 1);

  TriMesh mesh;
  if (kind == "ply") {
    mesh = from_ply(text, name);
  } else if (kind == "off") {
    mesh = parse_off(text, name);
  } else if (kind == "obj" || kind == "stl" || kind == "gltf" || kind == "glb") {
    if (kind == "stl") check_stl(text, name);
    mesh = from_assimp(text, path, kind, packed);
  } else {
    fail_input("{}: files of kind \".{}\" are not read; .ply, .obj, .stl, .gltf, .glb and .off are, also with .gz",
               name, kind);
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!is_finite(mesh.vertices[v]))
      fail_input("{}: vertex {} is ({}, {}, {}), not a finite place", name, v, mesh.vertices[v].x, mesh.vertices[v].y,
                 mesh.vertices[v].z);
  if (mesh.vertices.empty()) fail_input("{}: holds neither vertices nor faces; a mesh is wanted", name);
  if (mesh.triangles.empty())
    fail_input("{}: has {} vertices but no faces; a scene takes a cloud of points by `points: FILE`", name,
               mesh.vertices.size());
  return mesh;
}

TriMesh load_mesh(const std::string& name) { return is_asset(name) ? load_asset(name) : import_mesh(name); }

}  // namespace dreampm
