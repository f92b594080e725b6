// The motion of particles that carry it themselves.
#pragma once
#include "dreampm/backend/motion.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// True if a motion says no more than the particles of a world do: of solids it has their strain
/// too.
template <class R>
bool carries_motion(const World<R>& world) {
  return std::all_of(world.sets.begin(), world.sets.end(),
                     [](const auto& set) { return set.carries_motion && set.liquid; });
}

/// Copies velocities and gradients of the particles of one set, in their order; `less` is
/// subtracted from velocities [m/s].
template <class R>
void take_carried_motion(const ParticleSet<R>& set, const Vec3<R>& less, typename Motion<R>::Set& m) {
  resize_for_overwrite(m.velocity, set.size());
  resize_for_overwrite(m.gradient, set.size());
  m.energy.assign(set.size(), R(0));
  m.volume_ratio.assign(set.size(), R(1));
  parallel_for(set.size(), 1 << 12, [&](std::size_t p) {
    m.velocity[p] = Vec3<R>{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]} - less;
    for (std::size_t c = 0; c < 9; ++c)
      m.gradient[p](static_cast<int>(c / 3), static_cast<int>(c % 3)) = set.gradient[c][p];
  });
}

/// Copies velocities and gradients of all particles.
template <class R>
void take_carried_motion(const World<R>& world, Motion<R>& motion) {
  motion.sets.resize(world.sets.size());
  for (std::size_t s = 0; s < world.sets.size(); ++s) take_carried_motion(world.sets[s], Vec3<R>{}, motion.sets[s]);
}

/// Gives the particles of a set their motion, in their order; velocities `less` so much [m/s].
template <class R>
void carry_motion(const typename Motion<R>::Set& m, const Vec3<R>& less, ParticleSet<R>& set) {
  for (auto& column : set.own_velocity) resize_for_overwrite(column, set.size());
  for (auto& column : set.gradient) resize_for_overwrite(column, set.size());
  parallel_for(set.size(), 1 << 12, [&](std::size_t p) {
    const Vec3<R> v = m.velocity[p] - less;
    for (int a = 0; a < 3; ++a) set.own_velocity[static_cast<std::size_t>(a)][p] = v[a];
    for (std::size_t c = 0; c < 9; ++c)
      set.gradient[c][p] = m.gradient[p](static_cast<int>(c / 3), static_cast<int>(c % 3));
  });
}

}  // namespace dreampm
