// Sums over the nodes of a visit of the grid on a device. Without constructors, as they lie in the
// memory of a block.
#pragma once
#include "dreampm/backend/impulse_sum.h"
#include "dreampm/math/scalar.h"

namespace dreampm::gpu {

/// As NodeSums, of one node or more, in numbers of type N.
template <class N>
struct NodeTerms {
  N mass, moment[3], kinetic2, fastest2, arrived2;
  bool finite;

  static DM_FN NodeTerms none() { return {0, {0, 0, 0}, 0, 0, 0, true}; }
  template <class Other>
  DM_FN void add(const NodeTerms<Other>& b) {
    mass += b.mass, kinetic2 += b.kinetic2, arrived2 += b.arrived2;
    for (int a = 0; a < 3; ++a) moment[a] += b.moment[a];
    fastest2 = max(N(b.fastest2), fastest2);
    finite = finite && b.finite;
  }
};
/// Of a block of the grid and of all; `moment` about the scene's origin [kg m].
using GridTerms = NodeTerms<double>;

/// As ImpulseSumOf, and what reflection adds to the kinetic energy [J].
template <class N>
struct ImpulseTerms {
  N impulse[3], angular[3], work, gained;

  static DM_FN ImpulseTerms none() { return {{0, 0, 0}, {0, 0, 0}, 0, 0}; }
  static DM_FN ImpulseTerms of(const ImpulseSumOf<N>& p, N gained = 0) {
    return {{p.impulse.x, p.impulse.y, p.impulse.z}, {p.angular.x, p.angular.y, p.angular.z}, p.work, gained};
  }
  static DM_FN ImpulseTerms of_work(N work) { return {{0, 0, 0}, {0, 0, 0}, work, 0}; }
  DM_FN void add(const ImpulseTerms& b) {
    for (int a = 0; a < 3; ++a) impulse[a] += b.impulse[a], angular[a] += b.angular[a];
    work += b.work, gained += b.gained;
  }
  DM_FN ImpulseSumOf<N> sum() const {
    return {{impulse[0], impulse[1], impulse[2]}, {angular[0], angular[1], angular[2]}, work};
  }
};
using SourceTerms = ImpulseTerms<double>;

}  // namespace dreampm::gpu
