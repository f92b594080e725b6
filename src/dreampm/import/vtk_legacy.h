// VTK's legacy files: points and polygons.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads the text of a .vtk file, ASCII or binary, of versions up to 5.1: the points of POLYDATA
/// and UNSTRUCTURED_GRID, their velocities, ids and colors (point_arrays.h), and polygons, strips,
/// triangles and quads as faces. Other cells and data are passed over. Throws InputError naming
/// `name` and what is wrong.
Model parse_vtk(std::string_view text, const std::string& name);

}  // namespace dreampm
