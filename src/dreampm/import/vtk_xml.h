// VTK's XML files: points and polygons.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads the text of a .vtp or .vtu file: inline or appended data, in ASCII, base64 or raw, packed
/// by zlib or not, all pieces. What is read of it is as parse_vtk has it. Throws InputError naming
/// `name` and what is wrong.
Model parse_vtk_xml(std::string_view text, const std::string& name);

}  // namespace dreampm
