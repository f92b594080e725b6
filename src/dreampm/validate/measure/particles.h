// What a world's particles say: positions, columns by name, sums over slabs.
#pragma once
#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/physics/materials.h"
#include "dreampm/state/world.h"

namespace dreampm::validate {

/// Calls body(set, index within the set, scene position [m]) for every particle, in the order of
/// the columns.
template <class R, class Body>
void each_particle(const World<R>& w, const Body& body) {
  for (std::size_t s = 0; s < w.sets.size(); ++s) {
    const auto& set = w.sets[s];
    for (std::size_t b = 0; b < w.particle_blocks.size(); ++b)
      for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p)
        body(s, p, w.position(w.particle_blocks[b], Vec3<R>{set.u[0][p], set.u[1][p], set.u[2][p]}));
  }
}

/// Scene positions [m] in the order of ids, over all sets. Ids must run from 0.
template <class R>
std::vector<Vec3d> positions_by_id(const World<R>& w) {
  std::vector<Vec3d> x(w.particles());
  each_particle(w, [&](std::size_t s, std::size_t p, const Vec3d& at) { x.at(w.sets[s].id[p]) = at; });
  return x;
}

/// The mean position [m] of all particles: of the mass, where all are of one set.
template <class R>
Vec3d mean_position(const World<R>& w) {
  Vec3d sum{};
  for (const Vec3d& p : positions_by_id(w)) sum += p;  // by id: the same sum however they lie in memory
  return sum * (1.0 / static_cast<double>(w.particles()));
}

/// The place of a state column of that name. Throws std::out_of_range if the material has none.
inline std::size_t column_index(std::string_view material, std::string_view name) {
  std::size_t at = 0;
  bool found = false;
  Materials::with(material, [&]<class M>() {
    const auto& names = M::template State<float>::names;
    const auto it = std::find(std::begin(names), std::end(names), name);
    found = it != std::end(names);
    at = static_cast<std::size_t>(it - std::begin(names));
  });
  if (!found) throw std::out_of_range(std::string(material) + " has no column " + std::string(name));
  return at;
}
template <class R>
LargeVector<R>& column(ParticleSet<R>& set, std::string_view name) {
  return set.state.at(column_index(set.material, name));
}
template <class R>
const LargeVector<R>& column(const ParticleSet<R>& set, std::string_view name) {
  return set.state.at(column_index(set.material, name));
}

/// How much matter [m^3 of rest volume] lies in each one-cell slab along `axis`, from the low wall
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
