// The state of one particle, out of the columns of its set.
#pragma once
#include <cstddef>

#include "dreampm/physics/materials.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The state of particle `p` of a set of material M.
template <class M, class R>
typename M::template State<R> state_of(const ParticleSet<R>& set, std::size_t p) {
  typename M::template State<R> state;
  for (int c = 0; c < state_columns<M>; ++c) state[c] = set.state[static_cast<std::size_t>(c)][p];
  return state;
}

}  // namespace dreampm
