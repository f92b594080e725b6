// Sums over a world's particles: positions, slabs.
#pragma once
#include <algorithm>
#include <vector>

#include "dreampm/state/particle_view.h"

namespace dreampm::validate {

/// Calls body(set, index within the set, scene position [m]) for every particle, in the order of
/// the columns.
template <class R, class Body>
void each_particle(const World<R>& w, const Body& body) {
  for (std::size_t s = 0; s < w.sets.size(); ++s) {
    const ParticleSetView<R> particles(w, s);
    particles.for_each([&](std::size_t p, const Vec3d& at) { body(s, p, at); });
  }
}

/// Scene positions [m] in the order of ids, over all sets. Ids must run from 0.
template <class R>
std::vector<Vec3d> positions_by_id(const World<R>& w) {
  std::vector<Vec3d> x(w.particles());
  for (std::size_t s = 0; s < w.sets.size(); ++s) {
    const ParticleSetView<R> particles(w, s);
    particles.for_each([&](std::size_t p, const Vec3d& at) { x.at(particles.id(p)) = at; });
  }
  return x;
}

/// The mean position [m] of all particles: of the mass, where all are of one set.
template <class R>
Vec3d mean_position(const World<R>& w) {
  Vec3d sum{};
  for (const Vec3d& p : positions_by_id(w)) sum += p;  // by id: the same sum however they lie in memory
  return sum * (1.0 / static_cast<double>(w.particles()));
}

/// Returns the matter [m^3 of rest volume] in each one-cell slab along `axis`, from the low wall
/// on.
template <class R>
std::vector<double> slab_volumes(const World<R>& w, int axis, std::size_t set = 0) {
  std::vector<double> volume(static_cast<std::size_t>(w.high[axis] - w.low[axis]), 0);
  each_particle(w, [&](std::size_t s, std::size_t, const Vec3d& at) {
    if (s != set) return;
    const double cell = (at[axis] - w.origin[axis]) / w.dx;
    if (cell < 0 || cell >= static_cast<double>(volume.size())) return;
    volume[static_cast<std::size_t>(cell)] += w.sets[s].rest_volume;
  });
  return volume;
}

}  // namespace dreampm::validate
