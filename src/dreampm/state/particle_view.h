// How files outside of state/ and backend/ read particles: a set at a time, in scene units. What
// they read must be current in the World (backend/backend.h:Backend::download).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "dreampm/state/block_bounds.h"
#include "dreampm/state/particle_state.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The particles of one set of a world, which must outlive it and keep its particles in their
/// order.
template <class R>
class ParticleSetView {
 public:
  /// Throws std::out_of_range if the world has no set of that number.
  ParticleSetView(const World<R>& world, std::size_t set) : world_(world), set_(world.sets.at(set)) {}

  std::size_t size() const { return set_.size(); }
  /// The ids in the order of the particles, as all below.
  std::span<const std::uint32_t> ids() const { return set_.id; }
  std::uint32_t id(std::size_t p) const { return set_.id[p]; }
  /// The state of particle `p`; M: the set's material.
  template <class M>
  typename M::template State<R> state(std::size_t p) const {
    return state_of<M>(set_, p);
  }
  /// Returns the number of columns of state, 0 before the first matter.
  std::size_t columns() const { return set_.state.size(); }
  /// Returns a column by its number, as find_column() has it, or by its name. Throws
  /// std::out_of_range if the set's material has no such column, or the set no matter yet.
  std::span<const R> column(std::size_t c) const { return set_.state.at(c); }
  std::span<const R> column(std::string_view name) const { return column(column_index(set_.material, name)); }

  /// Calls body(p, x) for every particle, x its scene position [m].
  template <class Body>
  void for_each(const Body& body) const {
    for (std::size_t b = 0; b + 1 < set_.block_start.size(); ++b) for_block(b, body);
  }
  /// The same for those in blocks that reach into a box [m], between the steps.
  template <class Body>
  void for_each_near(const Box3d& box, const Body& body) const {
    for (std::size_t b = 0; b + 1 < set_.block_start.size(); ++b)
      if (block_reaches(world_, b, box)) for_block(b, body);
  }

 private:
  template <class Body>
  void for_block(std::size_t b, const Body& body) const {
    for (std::size_t p = set_.block_start[b]; p < set_.block_start[b + 1]; ++p)
      body(p, world_.position(world_.particle_blocks[b], Vec3<R>{set_.u[0][p], set_.u[1][p], set_.u[2][p]}));
  }

  const World<R>& world_;
  const ParticleSet<R>& set_;
};

}  // namespace dreampm
