// The Object File Format: vertices and polygons as text.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Reads the text of an OFF file (OFF, COFF, NOFF, STOFF and their mixtures; numbers after a
/// position or after a face's indices are skipped; polygons are cut into triangles). `name` is for
/// messages. Throws InputError: not an OFF, counts that the text cannot hold (before memory is
/// taken), cut short, not a number, an index out of range. Own code: assimp fills what is missing
/// with zeros.
Model parse_off(std::string_view text, const std::string& name);

}  // namespace dreampm
