// STL: triangles one by one, as text or binary.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads an STL file. A text may start with blanks, empty lines or a byte order mark, be in upper
/// case and hold several solids; a binary file may begin with the word "solid" too. Corners at one
/// place become one vertex. Bytes after the triangles of a binary file become a warning. `name` is
/// for messages. Throws InputError: cut short, more triangles promised than there are bytes (before
/// memory is taken), words that do not belong there (with their line).
Model parse_stl(std::string_view text, const std::string& name);

}  // namespace dreampm
