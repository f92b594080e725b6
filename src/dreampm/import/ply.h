// Meshes and point clouds of PLY files.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads element `vertex` (x y z, and vx vy vz where it has them), `face` and `tristrips` (lists
/// vertex_indices or vertex_index; -1 ends a strip) from the text of a PLY file: ASCII or binary of
/// either byte order, properties of any type in any order. Elements that name no vertices are
/// skipped. `name` is for messages. Bytes after the last element become a warning. Throws
/// InputError: what PlyValues throws for, another element that joins vertices (by its name), a
/// vertex or velocity that is not finite, an index out of range.
Model parse_ply(std::string_view text, const std::string& name);

}  // namespace dreampm
