// VTKHDF files: points and polygons.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads the bytes of a .vtkhdf file, PolyData or UnstructuredGrid. What is read of it is as
/// parse_vtk has it. Of a file with steps the first one, with a warning. Throws InputError naming
/// `name`: another kind of file, one that is damaged.
Model parse_vtkhdf(std::string_view bytes, const std::string& name);

}  // namespace dreampm
