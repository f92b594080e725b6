// Meshes and clouds of points from files.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "dreampm/geometry/model.h"
#include "dreampm/import/point_cloud.h"
#include "dreampm/shape.h"

namespace dreampm {

/// Reads a model: .ply .off .obj .stl .vtk .vtp .vtu .vtkhdf .bgeo .gltf .glb, in upper or lower
/// case, any of them also packed with gzip. Polygons are cut into triangles, corners at one place
/// joined in .stl and .gltf, scene nodes flattened; normals, colors and textures are dropped.
/// Coordinates stay in the file's unit. Faces that look the other way than their neighbors are
/// turned (alike.h). Every index is in range and every vertex finite. What was mended is in
/// `warnings`. No triangles: a cloud. Throws InputError naming the file and what is wrong: missing,
/// empty, cut short, not of its format, a count that the file cannot hold (refused before memory is
/// taken), an index out of range, a vertex that is not finite, an extension of glTF that changes
/// vertices.
Model read_model(const std::filesystem::path& path);

/// True if `path` names a PLY file (.ply, .PLY, .ply.gz).
bool is_ply(const std::filesystem::path& path);

/// The cloud of a file of points without faces; nothing of a mesh. Of PLY meshes only the header is
/// read.
std::optional<MovingCloud> read_if_cloud(const std::filesystem::path& path, double scale = 1);

/// read_model, where a cloud is refused too.
Model import_mesh(const std::filesystem::path& path);

/// The same, where `name` may also be asset:NAME (see asset.h).
Model load_model(const std::string& name);
Model load_mesh(const std::string& name);

/// The mesh of a shape as its file has it: load_mesh, or that of a height field.
Model mesh_of(const MeshShape& shape);

}  // namespace dreampm
