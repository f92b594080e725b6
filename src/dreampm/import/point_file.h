// Files of points from other programs, by the ending of their names.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// The ending of a name in lower case, without .gz: ".ply" of "A.PLY.gz".
std::string file_kind(const std::filesystem::path& path);

/// True if files of that ending may hold points.
bool is_point_kind(const std::string& kind);
/// Returns these endings: ".ply, .vtk, .vtp, .vtu, .vtkhdf, .bgeo".
std::string point_kinds();

/// The points of such a file, which may be packed with gzip, with velocities, ids, colors and faces
/// where it has them. Throws InputError naming the file: another ending, or what its reader
/// refuses.
Model read_point_file(const std::filesystem::path& path);
/// The same from the file's text, unpacked. `name` is for messages.
Model parse_point_file(const std::string& kind, std::string_view text, const std::string& name);

}  // namespace dreampm
