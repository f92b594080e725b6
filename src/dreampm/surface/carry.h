// What vertices of a surface take over from the particles around them.
#pragma once
#include <span>
#include <vector>

#include "dreampm/math/pigments.h"
#include "dreampm/math/vec.h"

namespace dreampm::surface {

/// Particles that a surface was wrapped around; at least one.
struct Carriers {
  std::span<const Vec3f> positions;  ///< m
  float spacing;                     ///< m, between them
};

// Each of these returns a value a vertex, from the particles within two spacings of it, the nearer
// the more; where there is none so near, from the nearest. Values are one a particle. The result
// does not depend on the number of threads.

/// The mean.
std::vector<float> carry_numbers(std::span<const Vec3f> vertices, const Carriers& particles,
                                 std::span<const float> values);
/// The value that weighs most: values are names, as numbers.
std::vector<float> carry_names(std::span<const Vec3f> vertices, const Carriers& particles,
                               std::span<const float> values);
/// The color that they mix to; colors are linear.
std::vector<Vec3f> carry_colors(std::span<const Vec3f> vertices, const Carriers& particles,
                                std::span<const Vec3f> colors, Mixing mixing);
/// The vorticity curl v [1/s] of the linear velocity that fits the particles within three spacings
/// best; a linear field comes out as it is, up to what keeps it finite where particles are few.
std::vector<Vec3f> carry_vorticity(std::span<const Vec3f> vertices, const Carriers& particles,
                                   std::span<const Vec3f> velocities);

}  // namespace dreampm::surface
