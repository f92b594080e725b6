// The divergence that liquids follow.
#pragma once
#include "dreampm/physics/transfer.h"

namespace dreampm {

/// Returns the excess of tr C over the divergence of the field that moves the particles [m/s
/// cells], of what a liquid gathered: G2PResult::affine_excess. N: a node, or a vector.
template <class N, class R>
DM_FN R divergence_excess(const Moments<N>& found, const Stencil<R>& s) {
  return found.bend[0].x * affine_excess(s.t[0]) + found.bend[1].y * affine_excess(s.t[1]) +
         found.bend[2].z * affine_excess(s.t[2]);
}

}  // namespace dreampm
