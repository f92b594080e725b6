// The passes over the particles of a World in a device's memory.
#pragma once
#include <array>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/set_memory.h"

namespace dreampm::gpu {

class ParticlePasses {
 public:
  /// `memory` has to outlive it.
  ParticlePasses(Device& device, Memory& memory) : device_(&device), memory_(memory) {}

  /// Must be called after every change of the lists of blocks: their number.
  void prepare(std::size_t particle_blocks);
  /// As Backend::g2p2g, but for images. The nodes become those of the step to come, whose fields
  /// `next` has in size. `looks`: whether motion is kept, for download_motion. `thin`: whether
  /// distances from thin colliders are in memory.
  PassStats g2p2g(World<float>& world, double dt, double dt_next, bool looks, bool thin, GridFields<float>& next);
  /// Fills Memory::momenta as GridUpdate::sub_cycle asks for it, from the velocities of nodes.
  /// `next`: as above.
  void find_viscous_forces(World<float>& world, double dt, GridFields<float>& next);
  /// m/s: the largest speed that a particle gathers.
  double fastest_particle(World<float>& world);
  /// What the last pass looked at.
  void download_motion(const World<float>& world, Motion<float>& motion) const;

 private:
  /// What all sets see of one pass.
  struct PassStep {
    World<float>& world;
    GridFields<float>& next;
    double dt, dt_next;
    bool looks, thin;
  };
  PassInput input_of(const World<float>& world, std::size_t set, bool thin) const;
  ArenaOutput arena(std::size_t target, GridFields<float>& next);
  ScatterBounds pass(const PassStep& step, const ScatterBounds& bounds, PassStats& total);
  void launch_pass(const PassStep& step, std::size_t set, const ScatterBounds& bounds);
  void sum_arenas(std::size_t target, const ScatterBounds& bounds, GridFields<float>& next, Buffer<Node<float>>& to);
  float launch_viscous(World<float>& world, double dt, const ScatterBounds& bounds, GridFields<float>& next);

  Device* device_;
  Memory& memory_;
  std::size_t blocks_ = 0;
  std::array<bool, targets> written_{};  ///< whether a set of this pass has written to a target's arenas
  std::vector<BlockSums> totals_;        ///< of a pass
  std::vector<float> speeds_;
};

}  // namespace dreampm::gpu
