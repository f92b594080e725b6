// VTKHDF files of points.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads the bytes of a .vtkhdf file: the points of PolyData and UnstructuredGrid, with velocities,
/// ids and colors (point_arrays.h). Of a file with steps the first one, with a warning. Throws
/// InputError naming `name`: another kind of file, one that holds polygons, one that is damaged.
Model parse_vtkhdf(std::string_view bytes, const std::string& name);

}  // namespace dreampm
