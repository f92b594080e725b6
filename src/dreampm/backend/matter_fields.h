// The parts of the matter that a reader or an edit names.
#pragma once

namespace dreampm {

/// A set of them.
enum class MatterFields : unsigned {
  none = 0,
  id = 1,        ///< ParticleSet::id
  position = 2,  ///< ParticleSet::u and block_start, World::particle_blocks
  state = 4,     ///< ParticleSet::state and own
  motion = 8,    ///< the Motion of the last pass that was asked for one
  nodes = 16,    ///< World::grid
  particles = id | position | state | motion,
  all = particles | nodes
};

constexpr MatterFields operator|(MatterFields a, MatterFields b) {
  return static_cast<MatterFields>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
constexpr MatterFields without(MatterFields fields, MatterFields part) {
  return static_cast<MatterFields>(static_cast<unsigned>(fields) & ~static_cast<unsigned>(part));
}
constexpr bool includes(MatterFields fields, MatterFields part) {
  return (static_cast<unsigned>(fields) & static_cast<unsigned>(part)) == static_cast<unsigned>(part);
}

}  // namespace dreampm
