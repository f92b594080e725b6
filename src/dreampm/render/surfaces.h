// The surfaces of the objects of a picture, in each medium that they may lie in.
#pragma once
#include <memory>
#include <vector>

#include "dreampm/render/intersect.h"

namespace dreampm::trace {

class Surfaces {
 public:
  explicit Surfaces(const Geometry& geometry);
  /// Of an object without an interior; `medium`: the object around it, or air.
  const Bsdf& at(int object, int medium) const {
    return *surfaces_[static_cast<std::size_t>(object * media_ + medium + 1)];
  }

 private:
  int media_;
  std::vector<std::shared_ptr<const Bsdf>> surfaces_;  ///< by object and medium; null where that cannot be
};

}  // namespace dreampm::trace
