// Wavefront OBJ: vertices and polygons as text.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads the lines v and f of an OBJ file; of a corner v/vt/vn the first number counts, which may
/// be negative, from the last vertex back. All other lines (normals, groups, materials, lines,
/// points, curves) are skipped. `name` is for messages. Throws InputError naming file and line: not
/// a number, an index out of range. Own code: assimp keeps coordinates in float only.
Model parse_obj(std::string_view text, const std::string& name);

}  // namespace dreampm
