// Particles as a program sees them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "dreampm/vec.h"

namespace dreampm {

/// The particles of one material, in the order of their ids; all arrays have one entry a particle.
/// They show the particles as they were when the view was asked for: steps and edits change nothing
/// in them. They are there as long as a copy of the view, or of its `keep`, is, even where the
/// simulation is not.
struct ParticleView {
  std::span<const std::uint32_t> id;  ///< unique in the simulation; never used again
  std::span<const Vec3f> position;    ///< m
  std::span<const Vec3f> velocity;    ///< m/s, of the last step; at the start as the scene says
  std::span<const float> J;           ///< volume over volume at rest [1]
  /// Linear red, green, blue, 0 to 1: of its body, else of its material's look; of clear matter
  /// what 0.1 m lets through.
  std::span<const Vec3f> color;
  std::shared_ptr<const void> keep;  ///< owns the arrays

  std::size_t size() const { return id.size(); }
};

}  // namespace dreampm
