#include "dreampm/backend/gpu/memory_need.h"

#include <algorithm>

#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/base/error.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu {

namespace {

constexpr std::size_t node_bytes = block_nodes * sizeof(Node<float>);  // of a field, in a block

/// Of a particle of the set.
std::size_t of_particle(const World<float>& world, const ParticleSet<float>& set) {
  const std::size_t columns = 3 + set.state.size() + (set.has_own_velocity() ? 3 : 0);
  // Columns and ids twice, two numbers of a sort, and the motion of a frame: velocity, its
  // gradient, energy and volume.
  constexpr std::size_t sort = 2 * sizeof(std::uint32_t), motion = (3 + 9 + 2) * sizeof(float);
  const std::size_t taken = world.sinks.empty() ? 0 : sizeof(std::uint32_t) + sizeof(Vec3<float>);
  // Distances from thin colliders, and their way from the host.
  const std::size_t distance = world.colliders.empty() ? 0 : 2 * sizeof(Node<float>) + sizeof(Vec3<float>);
  return 2 * (columns * sizeof(float) + sizeof(std::uint32_t)) + sort + taken + motion + distance;
}

/// Of a block of the grid, for its contact with colliders; points of surfaces are few where matter
/// is.
std::size_t of_collider_block(const World<float>& world) {
  if (world.colliders.empty()) return 0;
  const std::size_t distances = 2 * node_bytes;  // and their way from the host
  constexpr std::size_t points = 8, stencil = 27 * (2 * sizeof(float) + sizeof(PointOfNode));
  return distances + block_nodes * (sizeof(ContactNode) + sizeof(NodeState)) +
         points * (sizeof(ContactPoint) + sizeof(PointState) + sizeof(Vec3<float>) + stencil);
}

}  // namespace

std::size_t bytes_needed(const World<float>& world) {
  std::size_t bytes = 0, fields = 0, largest = 0;
  for (const ParticleSet<float>& set : world.sets) {
    largest = std::max(largest, set.size());
    bytes += set.size() * of_particle(world, set);
  }
  bytes += std::min(largest, seeds_at_once) * sizeof(PlacedSeed);
  visit_nodes(world.grid, [&](const auto& field, const auto&) { fields += field.needed(world); });
  const std::size_t velocity_fields = world.needs_solid_field() ? 2 : 1;
  // Stages of viscosity, where any may come: stress, and of nodes momenta, velocities before and
  // their change.
  const bool stages = world.settings.sub_cycles && world.holds_liquid(0);
  if (stages && world.viscous_stages == 0) fields += velocity_fields;
  constexpr std::size_t cells = block_nodes * sizeof(std::uint32_t);
  constexpr std::size_t tables = 512;  // of a block, about
  bytes += world.particle_blocks.size() *
           (fields * arena_nodes * sizeof(NodeCounts) +
            world.sets.size() * (2 * cells + SortInput::neighbors * sizeof(float)) + sizeof(BlockSums) + tables);
  const bool solid = std::any_of(world.sets.begin(), world.sets.end(), [](const auto& set) { return !set.liquid; });
  const std::size_t gaps = solid ? block_gaps * sizeof(float) : 0;
  const std::size_t forces =
      world.fields.empty() ? 0 : velocity_fields * block_nodes * sizeof(Vec3<float>) + sizeof(SourceTerms);
  // One more field is on its way in a sort.
  bytes += world.grid.blocks.size() * ((fields + 1 + (stages ? 3 * velocity_fields : 0)) * node_bytes + gaps + forces +
                                       of_collider_block(world) + tables);
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
