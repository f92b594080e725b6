// Houdini's classic .bgeo: particles.
#pragma once
#include <string>
#include <string_view>

#include "dreampm/geometry/model.h"

namespace dreampm {

/// Points of a classic binary .bgeo of version 5 (what Houdini wrote before 12, and Partio and
/// SPlisHSPlasH write), with the attributes v, id and Cd where it has them; primitives are passed
/// over. Throws InputError naming `name`: the newer .bgeo of JSON, another version, a file that is
/// cut short.
Model parse_bgeo(std::string_view text, const std::string& name);

}  // namespace dreampm
