// Forces that act on matter from afar.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "dreampm/model/matter.h"
#include "dreampm/vec.h"

namespace dreampm::model {

/// A force of a type that docs/reference/scene.md lists under `fields`: drag, wind, attractor or
/// brush, with values of its keys.
struct ForceField {
  std::string name;
  std::string type;
  Values numbers{};                                     ///< by key: rate, radius, ...
  std::map<std::string, Vec3d, std::less<>> vectors{};  ///< by key: velocity, point, ...
  std::optional<Box3d> box{};                           ///< m: where it acts; absent: everywhere
};

}  // namespace dreampm::model
