#include "dreampm/import/import.h"

#include "dreampm/base/error.h"
#include "dreampm/geometry/alike.h"
#include "dreampm/import/asset.h"
#include "dreampm/import/gltf.h"
#include "dreampm/import/gzip.h"
#include "dreampm/import/heightfield.h"
#include "dreampm/import/obj.h"
#include "dreampm/import/off.h"
#include "dreampm/import/ply_header.h"
#include "dreampm/import/point_file.h"
#include "dreampm/import/stl.h"

namespace dreampm {

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
    model = parse_gltf(text, name, path.parent_path());
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
