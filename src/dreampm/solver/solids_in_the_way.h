// Colliders and rigid bodies where emitters would give.
#pragma once
#include <vector>

#include "dreampm/state/world.h"

namespace dreampm {

/// Matter may start that deep inside of a collider [cells], where it is pressed out.
inline constexpr double shallow_overlap = 0.1;

/// The colliders of a world, rigid bodies among them, that reach into a box, as they stand now.
class SolidsInTheWay {
 public:
  template <class R>
  SolidsInTheWay(const World<R>& world, const Box3d& box);
  /// True if a place of the box lies inside of a solid.
  bool cover(const Vec3d& p) const;

 private:
  struct Solid {
    const Collider* collider;
    Vec3d shift;  ///< m, of a copy on periodic axes
  };
  std::vector<Solid> solids_;
  double depth_;  ///< m
};

}  // namespace dreampm
