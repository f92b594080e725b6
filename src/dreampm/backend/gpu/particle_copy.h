// Copies of particles for programs on the device: positions in the scene, one particle after the
// other.
#pragma once
#include <cstdint>

#include "dreampm/backend/gpu/block.h"
#include "dreampm/backend/gpu/block_particles.h"
#include "dreampm/state/scene_position.h"

namespace dreampm::gpu {

/// Writes those of a set; a block of threads takes a block of particles.
struct CopyParticles {
  static constexpr int threads = 128;
  struct Shared {};
  ScenePosition scene;
  const Vec3i* blocks;               ///< those of particles
  const std::uint32_t* block_start;  ///< by block of particles, and the end
  const float* u[3];                 ///< as ParticleSet::u
  const float* velocity;             ///< three a particle [m/s]
  const std::uint32_t* id;
  // Where copies go, each or null: positions [m] and velocities are three a particle.
  float *to_position, *to_velocity;
  std::uint32_t* to_id;

  template <class Block>
  DM_FN void operator()(Block& block, Shared&) const {
    const int b = block.index();
    block.each_thread([&](int t) {
      each_particle<threads>(block_start, static_cast<std::uint32_t>(b), t, [&](std::uint32_t p) {
        const Vec3d x = scene(blocks[b], Vec3<float>{u[0][p], u[1][p], u[2][p]});
        for (int a = 0; a < 3; ++a) {
          const std::uint64_t at = 3 * std::uint64_t{p} + static_cast<std::uint64_t>(a);
          if (to_position) to_position[at] = static_cast<float>(x[a]);
          if (to_velocity) to_velocity[at] = velocity[at];
        }
        if (to_id) to_id[p] = id[p];
      });
    });
  }
};

}  // namespace dreampm::gpu
