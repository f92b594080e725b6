// The motion of particles that carry it themselves.
#pragma once
#include "dreampm/backend/motion.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Whether a motion says no more than the particles of a world do: of solids it has their strain
/// too.
template <class R>
bool carries_motion(const World<R>& world) {
  return std::all_of(world.sets.begin(), world.sets.end(),
                     [](const auto& set) { return set.carries_motion && set.liquid; });
}

/// In their order.
template <class R>
void take_carried_motion(const World<R>& world, Motion<R>& motion) {
  motion.sets.resize(world.sets.size());
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<R>& set = world.sets[s];
    auto& m = motion.sets[s];
    resize_for_overwrite(m.velocity, set.size());
    resize_for_overwrite(m.gradient, set.size());
    m.energy.assign(set.size(), R(0));
    m.volume_ratio.assign(set.size(), R(1));
    parallel_for(set.size(), 1 << 12, [&](std::size_t p) {
      m.velocity[p] = {set.own[0][p], set.own[1][p], set.own[2][p]};
      for (std::size_t c = 0; c < 9; ++c)
        m.gradient[p](static_cast<int>(c / 3), static_cast<int>(c % 3)) = set.gradient[c][p];
    });
  }
}

}  // namespace dreampm
