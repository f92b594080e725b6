// Stage 7: bodies that touch no wall get the volume of their particles; the smallest are taken out,
// to be given shapes of their own.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/surface/bodies.h"

namespace dreampm::surface {

/// Bodies of fewer particles are drops: not smoothed, and scaled as a whole.
inline constexpr std::uint32_t kDropParticles = 80;

/// The full number of steps would shrink a small body to nothing: the share that one of n particles
/// takes, 0 (drops) to 1.
inline float smoothing_share(std::uint32_t particles) {
  return std::clamp((static_cast<float>(particles) - kDropParticles) / 1000.0f, 0.0f, 1.0f);
}

/// A blurred field makes convex bodies too small. Drops are rounded and scaled about their center
/// to n spacing^3; larger free bodies move along their normals, by at most spacing/2 in each of
/// three passes.
void restore_volumes(QuadMesh& mesh, const Bodies& bodies, float spacing);

/// A drop too small for the grid.
struct SmallDrop {
  Vec3f center{};               ///< m
  Vec3f velocity{};             ///< m/s
  std::uint32_t particles = 0;  ///< its volume in spacing^3
  float remaining = 1;          ///< the share of that which is left where it lies on something
};

/// Takes out of the mesh: bodies of at most 3 particles, compact bodies of at most 8, and bodies
/// that hold no particle at all. Returns them, and one drop for each particle that no body holds.
/// `velocities`, `remaining`: one a particle, or empty.
std::vector<SmallDrop> take_small_drops(QuadMesh& mesh, Bodies& bodies, std::span<const Vec3f> points,
                                        std::span<const Vec3f> velocities, std::span<const float> remaining,
                                        float spacing);

}  // namespace dreampm::surface
