// Particles as a program sees them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

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
  /// Linear red, green, blue, 0 to 1: of its body or emitter, else of its material's look; of clear
  /// matter what 0.1 m lets through.
  std::span<const Vec3f> color;
  std::shared_ptr<const void> keep;  ///< owns the arrays

  std::size_t size() const { return id.size(); }
};

/// An attribute of the particles of one material, in the order of their ids. Its array is there as
/// long as a copy of it, or of its `keep`, is.
struct AttributeView {
  /// `width` numbers a particle, one particle after the other; a matrix row by row.
  std::span<const float> values;
  std::size_t width = 1;             ///< 9: a matrix of 3 x 3
  std::string_view unit;             ///< "1": a number without one
  std::shared_ptr<const void> keep;  ///< owns the array

  std::size_t size() const { return values.size() / width; }
};

/// The arrays of particles that `Simulation::visit` and `Simulation::device_particles` show.
struct ParticleFields {
  bool position = true, velocity = false, id = false;
};

/// Some particles of one material, as they lie in memory. The arrays are there until the function
/// returns that they were given to; those that were not asked for are empty.
struct ParticleBatch {
  std::size_t first = 0, count = 0;   ///< how many of the material came before; how many these are
  std::span<const Vec3d> position;    ///< m
  std::span<const Vec3d> velocity;    ///< m/s, of the last step
  std::span<const std::uint32_t> id;  ///< unique in the simulation

  std::size_t size() const { return count; }
};

}  // namespace dreampm
