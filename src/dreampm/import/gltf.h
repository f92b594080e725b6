// Meshes of glTF 2.0 files. The layout is that of the specification by Khronos
// (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html). Own code: libraries take what such a
// file says of its own sizes on trust.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// The triangles, strips and fans of the scene in a .gltf or .glb file, each node where it stands;
/// in a file without a scene those of all nodes, or of all meshes where it has no nodes either.
/// Corners at one place are joined; normals, colors, skins and animations are dropped. Buffers that
/// the file names are looked for in `folder`, where names may be written as URIs. Throws InputError
/// naming the file (`name`) and the value.
Model parse_gltf(std::string_view text, const std::string& name, const std::filesystem::path& folder);

}  // namespace dreampm
