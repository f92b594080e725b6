#include "dreampm/solver/solids_in_the_way.h"

#include <algorithm>

#include "dreampm/contact/collider_view.h"

namespace dreampm {

template <class R>
SolidsInTheWay::SolidsInTheWay(const World<R>& world, const Box3d& box) : depth_(shallow_overlap * world.dx) {
  for (const Collider& c : world.colliders) {
    const Box3d own = c.bounds();
    for (const Vec3d& shift : periodic_copies(world, c)) {
      bool meets = true;
      for (int a = 0; a < 3; ++a)
        meets = meets && own.min[a] + shift[a] <= box.max[a] && own.max[a] + shift[a] >= box.min[a];
      if (meets) solids_.push_back({&c, shift});
    }
  }
}

bool SolidsInTheWay::cover(const Vec3d& p) const {
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const Solid& s) { return s.collider->distance(p - s.shift) < -depth_; });
}

template SolidsInTheWay::SolidsInTheWay(const World<float>&, const Box3d&);
template SolidsInTheWay::SolidsInTheWay(const World<double>&, const Box3d&);

}  // namespace dreampm
