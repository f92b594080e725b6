#include "dreampm/backend/gpu/memory_need.h"

#include <algorithm>

#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/base/error.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu {

std::size_t bytes_needed(const World<float>& world) {
  std::size_t bytes = 0, fields = 0, largest = 0;
  for (const ParticleSet<float>& set : world.sets) {
    const std::size_t columns = 3 + set.state.size() + (set.has_own_velocity() ? 3 : 0);
    // Columns and ids twice, two numbers of a sort, and the motion of a frame: velocity, its
    // gradient, energy and volume.
    constexpr std::size_t sort = 2 * sizeof(std::uint32_t), motion = (3 + 9 + 2) * sizeof(float);
    const std::size_t taken = world.sinks.empty() ? 0 : sizeof(std::uint32_t);
    largest = std::max(largest, set.size());
    const std::size_t distance = world.colliders.empty() ? 0 : 4 * sizeof(float);
    bytes += set.size() * (2 * (columns * sizeof(float) + sizeof(std::uint32_t)) + sort + taken + motion + distance);
  }
  bytes += std::min(largest, seeds_at_once) * sizeof(PlacedSeed);
  visit_nodes(world.grid, [&](const auto& field, const auto&) { fields += field.needed(world); });
  // Stages of viscosity, where any may come: momenta, the velocities before and their change, by
  // field.
  const std::size_t of_stages = !world.settings.sub_cycles || !world.holds_liquid(0) ? 0
                                : world.needs_solid_field()                          ? 6
                                                                                     : 3;
  constexpr std::size_t nodes = block_nodes * sizeof(Node<float>), cells = block_nodes * sizeof(std::uint32_t);
  constexpr std::size_t tables = 512;  // of a block, about
  bytes += world.particle_blocks.size() *
           (fields * arena_nodes * sizeof(NodeCounts) +
            world.sets.size() * (2 * cells + SortInput::neighbors * sizeof(float)) + sizeof(BlockSums) + tables);
  // One more field is on its way in a sort. Colliders have two of their own, and at their surfaces
  // copies of what moves, and of the gaps of solids.
  std::size_t of_colliders = 0, gaps = 0;
  if (!world.colliders.empty()) {
    of_colliders = 2 + (world.needs_solid_field() ? 2 : 1) + 4;
    const bool solid = std::any_of(world.sets.begin(), world.sets.end(), [](const auto& set) { return !set.liquid; });
    gaps = solid ? 2 * block_gaps * sizeof(float) : 0;
  }
  bytes += world.grid.blocks.size() * ((fields + 1 + of_colliders + of_stages) * nodes + gaps + tables);
  return bytes + bytes / 8;  // Buffers have room to grow
}

void check_room(const Device& device, const World<float>& world) {
  const std::size_t needed = bytes_needed(world), there = device.memory().free + device.held();
  if (needed <= there) return;
  constexpr double mb = 1 << 20;
  fail_run(
      "{}: {} particles need about {:.1f} MB of its memory, and {:.1f} MB are free; fewer particles need less: "
      "a larger space.spacing",
      device.about(), world.particles(), static_cast<double>(needed) / mb, static_cast<double>(there) / mb);
}

}  // namespace dreampm::gpu
