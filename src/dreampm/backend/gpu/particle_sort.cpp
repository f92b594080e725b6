#include "dreampm/backend/gpu/particle_sort.h"

#include <algorithm>
#include <array>

#include "dreampm/backend/gpu/launch.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu {
namespace {

constexpr std::size_t ways = SortInput::neighbors;

/// The blocks of threads that a kernel needs for `items` of one thread each.
template <class K>
std::size_t blocks_for(std::size_t items) {
  return (items + K::threads - 1) / K::threads;
}

}  // namespace

ParticleSort::ParticleSort(Device& device)
    : device_(&device), moves_(device), targets_(device), before_(device), cells_(device), carried_(device) {}

bool ParticleSort::takes(const World<float>& world) {
  return world.sinks.empty() &&
         std::none_of(world.sets.begin(), world.sets.end(), [](const auto& set) { return set.carries_motion; });
}

void ParticleSort::operator()(World<float>& world, Memory& memory) {
  count_moves(world, memory);
  plan_.find_blocks(world);
  find_targets();
  find_cells(world, memory);
  for (std::size_t s = 0; s < world.sets.size(); ++s) move(world, s, memory.sets[s]);
  world.drift = 0;
  carry_nodes(world, memory);
}

SortInput ParticleSort::input(const SetMemory& set) const {
  SortInput in{{set.now.u[0].data(), set.now.u[1].data(), set.now.u[2].data()}, set.block_start.data(), {}};
  std::copy(alike_.begin(), alike_.end(), in.alike);
  return in;
}

/// Asks the device how many particles move where, for the plan.
void ParticleSort::count_moves(World<float>& world, Memory& memory) {
  plan_.begin(world);
  alike_ = first_alike(world);
  const std::size_t blocks = plan_.old_blocks().size(), sets = world.sets.size();
  while (sets_.size() < sets) sets_.emplace_back(*device_);
  moves_.resize(sets * blocks * ways);
  for (std::size_t s = 0; s < sets; ++s)
    launch(*device_, CountMoves{input(memory.sets[s]), moves_.data() + s * blocks * ways}, blocks);
  resize_for_overwrite(counted_, moves_.size());
  moves_.download(counted_);
  parallel_for(blocks, 64, [&](std::size_t b) {
    std::uint64_t around = 0;
    for (std::size_t s = 0; s < sets; ++s) {
      auto& runs = plan_.moves(s).runs[b];
      std::uint32_t at = world.sets[s].block_start[b];
      for (std::size_t n = 0; n < ways; ++n) {
        runs[n] = at;
        const auto count = static_cast<std::uint32_t>(counted_[(s * blocks + b) * ways + n]);
        if (count > 0) around |= halo_bit(neighbor_offset(static_cast<int>(n)));
        at += count;
      }
      runs[ways] = at;
    }
    plan_.moves_to(b, around);
  });
}

void ParticleSort::find_targets() {
  to_.assign(plan_.old_blocks().size() * ways, -1);
  const auto& sources = plan_.sources();
  for (std::size_t b = 0; b < sources.size(); ++b)
    for (std::uint32_t i = 0; i < sources[b].count; ++i) {
      const std::uint32_t from = sources[b].of[i];
      to_[std::size_t{from / 32} * ways + from % 32] = static_cast<std::int32_t>(b);
    }
  targets_.upload(to_);
}

/// Finds where the particles of every new cell begin, and on the host which cells have any.
void ParticleSort::find_cells(World<float>& world, Memory& memory) {
  const std::size_t old = plan_.old_blocks().size(), blocks = plan_.sources().size(), cells = blocks * block_nodes;
  cells_.resize(2 * blocks);
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    SetRoom& room = sets_[s];
    SetMemory& set = memory.sets[s];
    room.counts.resize(cells), room.start.resize(cells), room.number.resize(set.now.u[0].size());
    set.next_block_start.upload(plan_.moves(s).start);
    launch(*device_, ClearCounts{room.counts.data(), static_cast<std::int64_t>(cells)}, blocks_for<ClearCounts>(cells));
    launch(*device_, CountCells{input(set), {targets_.data()}, room.counts.data(), room.number.data()}, old);
    launch(*device_,
           StartCells{room.counts.data(), set.next_block_start.data(), room.start.data(), cells_.data(), s == 0},
           blocks);
  }
  resize_for_overwrite(halves_, cells_.size());
  cells_.download(halves_);
  resize_for_overwrite(occupied_, blocks);
  for (std::size_t b = 0; b < blocks; ++b) occupied_[b] = halves_[2 * b] | std::uint64_t{halves_[2 * b + 1]} << 32;
}

void ParticleSort::move(World<float>& world, std::size_t number, SetMemory& memory) {
  ParticleSet<float>& set = world.sets[number];
  SetRoom& room = sets_[number];
  auto& start = plan_.moves(number).start;
  const std::size_t size = start.back(), blocks = plan_.sources().size();
  room.from.resize(size);
  memory.next.fit(memory.now);
  memory.next_id.resize(size);
  launch(*device_,
         FillPlaces{input(memory), {targets_.data()}, room.start.data(), room.number.data(), room.from.data()},
         plan_.old_blocks().size());
  launch(*device_, SortPlaces{room.start.data(), memory.next_block_start.data(), room.from.data()}, blocks);
  const bool own = set.has_own_velocity();
  launch(*device_,
         MoveParticles{room.from.data(), static_cast<std::uint32_t>(size),
                       static_cast<std::uint32_t>(memory.now.state.size()), memory.now.pointers(own),
                       memory.next.pointers(own), memory.id.data(), memory.next_id.data()},
         blocks_for<MoveParticles>(size));
  std::swap(memory.now, memory.next);
  std::swap(memory.id, memory.next_id);
  std::swap(memory.block_start, memory.next_block_start);
  memory.now.shorten(size);
  set.block_start.swap(start);
  visit_fields(set, [&]<class F>(const F& field, auto& member) {
    if constexpr (F::use.carried)
      if (field.needed(set)) visit_columns(member, [&](auto& column) { resize_for_overwrite(column, size); });
  });
}

void ParticleSort::carry_nodes(World<float>& world, Memory& memory) {
  if (!topology_.lay(world, occupied_)) return;
  topology_.find_before(world, before_home_);
  before_.upload(before_home_);
  const std::size_t blocks = world.grid.blocks.size();
  visit_nodes(world.grid, [&]<class F>(const F& field, Nodes<float>& nodes) {
    if constexpr (F::use.carried) {
      Buffer<Node<float>>& there = memory.nodes[target_of(world.grid, nodes)];
      carried_.resize(field.needed(world) ? blocks * block_nodes : 0);
      if (carried_.size() > 0) launch(*device_, CarryNodes{before_.data(), there.data(), carried_.data()}, blocks);
      std::swap(there, carried_);
      resize_for_overwrite(nodes, there.size());
    }
  });
}

}  // namespace dreampm::gpu
