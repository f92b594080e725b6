// The force fields of a world, ready for the nodes of one step.
#pragma once
#include <boost/container/small_vector.hpp>

#include "dreampm/state/world.h"

namespace dreampm {

template <class R>
class FieldSteps {
 public:
  FieldSteps(const World<R>& world, double dt);
  bool any() const { return !fields_.empty(); }
  /// True if any field acts at a node of that grid block.
  bool any_in(const World<R>& world, const Vec3i& block) const;
  /// The velocity [m/s] after all fields, one after the other, at scene position `x` [m].
  Vec3<R> apply(Vec3<R> v, const Vec3d& x) const;
  /// A bound of the speed [m/s] after the step at `x`, for any velocity of at most `speed`.
  R fastest(R speed, const Vec3d& x) const;

  struct One {
    Fields::Step<R> step;
    Box3d box;  ///< where it acts; everything where the field is not limited
  };
  auto begin() const { return fields_.begin(); }
  auto end() const { return fields_.end(); }

 private:
  boost::container::small_vector<One, 4> fields_;  ///< made anew in every step, which should take no memory
};

/// A bound of node speeds [m/s] after a step of `dt` from now, for matter that moves at `speed` at
/// most: over every node of the grid, which holds all that matter reaches within two cells. Never
/// below `speed`.
template <class R>
double fastest_after_fields(const World<R>& world, double speed, double dt);

}  // namespace dreampm
