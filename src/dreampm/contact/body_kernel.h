// The kernel table of a rigid body: the fraction of a node's kernel that the body blocks, tabulated
// once in its own frame. As the body moves nodes read the table: an integral for each node and step
// would cost many times the step itself.
#pragma once
#include <memory>

#include "dreampm/geometry/brick_grid.h"
#include "dreampm/geometry/region.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// The kernel table of a body that no other solid is near. The kernel of the table has the axes of
/// the body, that of a node those of the grid: their parts inside a plane differ by 0.006 at most,
/// as the second moments of both are the same in every direction.
class BodyKernel {
 public:
  BodyKernel() = default;
  /// `dx` in m.
  BodyKernel(const std::shared_ptr<const Region>& shape, double dx);

  /// The part [0, 1] of the kernel of a node at `p` [m] that lies inside of the body.
  double inside(const Vec3d& p) const;
  /// True if a particle near a surface at `p` [m] needs its exact distance (contact/thin_places.h).
  bool is_thin(const Vec3d& p) const;
  /// True if the body has such places.
  bool any_thin() const { return any_thin_; }

 private:
  Vec3d middle_{};  ///< m, of the bounds
  double cells_a_meter_ = 0;
  BrickGrid inside_;  ///< 1/2 less the part inside
  BrickGrid thin_;    ///< negative where it is thin
  bool any_thin_ = false;
};

}  // namespace dreampm
