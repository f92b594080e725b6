// Triangle meshes from files.
#pragma once
#include <filesystem>
#include <string>

#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// Reads a mesh: .ply and .off (own readers), .obj .stl .gltf .glb (assimp), any of them also as .gz.
/// Polygons are cut into triangles, equal vertices joined by assimp's formats, scene nodes flattened; normals, colours
/// and textures are dropped. Coordinates stay in the file's unit. Every index is in range and every vertex finite.
/// Throws InputError naming the file and what is wrong: missing, empty, cut short, not of its format, a count that the
/// file cannot hold (refused before memory is taken), an index out of range, a vertex that is not finite, no faces.
TriMesh import_mesh(const std::filesystem::path& path);

/// import_mesh, where `name` may also be asset:NAME (see asset.h).
TriMesh load_mesh(const std::string& name);

}  // namespace dreampm
