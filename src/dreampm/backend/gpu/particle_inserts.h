// New matter in a World whose particles and nodes lie in a device's memory, as insert() and
// scatter_seeds(): the same bits. Seeds go there; what was there stays there, but for the nodes of
// the blocks that seeds reach.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/grid_layout.h"
#include "dreampm/state/insert_plan.h"

namespace dreampm::gpu {

class ParticleInserts {
 public:
  /// What it is handed has to outlive it.
  ParticleInserts(Device& device, GridLayout& layout, SomeNodes& nodes);

  // The parts of an insertion, in this order. Particles and nodes have to be current in `memory`,
  // and are afterwards.

  /// Gives the World its lists of blocks, and the set's arrays their sizes. Throws RunError where a
  /// seed has no finite position, or the device no room; World and `memory` are as before then.
  void begin(World<float>& world, Memory& memory, std::size_t set, std::span<const ParticleSeed> seeds);
  /// Brings particles, seeds and nodes to their places.
  void place(World<float>& world, Memory& memory);
  /// Adds what the seeds give to the nodes; those that it looks at are overwritten in the World.
  /// `stencil_blocks`: by block of particles.
  PassStats scatter(World<float>& world, Memory& memory, const Obstacles& obstacles,
                    const std::vector<StencilBlocks>& stencil_blocks);

 private:
  std::vector<std::uint64_t> held_cells(const World<float>& world, const std::vector<std::uint32_t>& halves,
                                        const std::vector<Vec3i>& old_blocks) const;
  void download_cells(const World<float>& world, Memory& memory);
  void place_seeds(const ParticleSet<float>& set, SetMemory& memory);
  std::vector<std::uint32_t> empty_at_colliders(World<float>& world, Memory& memory, const Obstacles& obstacles);

  Device* device_;
  GridLayout& layout_;
  SomeNodes& nodes_;
  // Of the insertion that has begun.
  std::size_t set_ = 0;
  std::span<const ParticleSeed> seeds_;
  std::optional<InsertPlan<float>> plan_;
  bool laid_ = false;  ///< whether the grid has other blocks now

  Buffer<PlacedSeed> placed_;
  Buffer<std::uint32_t> cells_;
  Buffer<std::int32_t> filled_;
  std::vector<PlacedSeed> placed_home_;
  std::vector<std::uint32_t> halves_;
  std::vector<std::int32_t> filled_home_;
};

}  // namespace dreampm::gpu
