// Particles as a program sees them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "dreampm/vec.h"

namespace dreampm {

/// The particles of one material, in the order of their ids; all arrays have one entry a particle.
/// Views are valid until the simulation that gave them is stepped, edited or destroyed.
struct ParticleView {
  std::span<const std::uint32_t> id;  ///< unique in the simulation; never used again
  std::span<const Vec3f> position;    ///< m
  std::span<const Vec3f> velocity;    ///< m/s, of the last step; at the start as the scene says
  std::span<const float> J;           ///< volume over volume at rest [1]
  /// Linear red, green, blue, 0 to 1: of its body, else of its material's look; of clear matter
  /// what 0.1 m lets through.
  std::span<const Vec3f> color;

  std::size_t size() const { return id.size(); }
};

}  // namespace dreampm
