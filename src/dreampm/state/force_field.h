// A force field of a scene: its formula, and where it acts.
#pragma once
#include <optional>
#include <string>

#include "dreampm/geometry/region.h"
#include "dreampm/physics/fields.h"

namespace dreampm {

/// A force that acts at every node, or at those within a box [m].
struct ForceField {
  std::string name;
  AnyField field;
  std::optional<Box3d> box;  ///< absent: everywhere
};

}  // namespace dreampm
