// The parts of the PLY format that meshes and point clouds need, read with every check.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

struct PlyContent {
  std::vector<Vec3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< polygons as fans
};

/// Reads element `vertex` (x y z) and, if `faces`, element `face` (vertex_indices or vertex_index) from the text of a
/// PLY file: ASCII or binary of either byte order, properties of any type in any order; all else is skipped. `name` is
/// for messages. Throws InputError: not a PLY, a header that does not end or cannot be, more elements promised than the
/// text can hold (before memory is taken), cut short, not a number, not finite, an index out of range.
PlyContent parse_ply(std::string_view text, const std::string& name, bool faces);

}  // namespace dreampm
