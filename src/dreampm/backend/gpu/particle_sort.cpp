#include "dreampm/backend/gpu/particle_sort.h"

#include <algorithm>
#include <array>

#include "dreampm/backend/gpu/launch.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/neighbors.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/take_out.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu {
namespace {

constexpr std::size_t ways = SortInput::neighbors;

/// The grid's blocks that particles of those blocks may reach, rising.
std::vector<std::uint32_t> grid_blocks_at(const World<float>& world, const std::vector<std::uint32_t>& blocks) {
  std::vector<std::uint32_t> reached;
  for (const std::uint32_t b : blocks)
    for (const std::int32_t g : stencil_blocks_in(world.grid.blocks, world, world.particle_blocks[b]))
      if (g != BlockList::none) reached.push_back(static_cast<std::uint32_t>(g));
  std::sort(reached.begin(), reached.end());
  reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
  return reached;
}

}  // namespace

ParticleSort::ParticleSort(Device& device, GridLayout& layout, SomePlaces& places, SomeNodes& nodes)
    : device_(&device),
      layout_(layout),
      places_(places),
      nodes_(nodes),
      moves_(device),
      targets_(device),
      cells_(device) {}

void ParticleSort::operator()(World<float>& world, Memory& memory) {
  find_taken(world, memory);
  count_moves(world, memory);
  plan_.find_blocks(world);
  find_targets();
  find_cells(world, memory);
  for (std::size_t s = 0; s < world.sets.size(); ++s) move(world, s, memory.sets[s]);
  world.drift = 0;
  if (layout_.lay(world, cells_from(halves_))) layout_.carry(world, memory);
}

/// Finds the particles that sinks take, and hands the device their numbers.
void ParticleSort::find_taken(World<float>& world, Memory& memory) {
  while (sets_.size() < world.sets.size()) sets_.emplace_back(*device_);
  for (SetRoom& room : sets_) room.taken.resize(0), room.taken_start.resize(0);
  if (!sinks_take(world)) return;
  const std::vector<std::uint32_t> near = blocks_at_sinks(world, false);
  places_.download(world, memory, near);
  nodes_.choose(grid_blocks_at(world, near));
  for (std::size_t f = 0; f < 2; ++f)
    if (!world.grid.field(f).empty()) nodes_.download(world, memory, of_field(Target::nodes, f));
  const std::vector<std::vector<std::uint32_t>> taken = take_out(world, false);
  for (std::size_t s = 0; s < taken.size(); ++s) {
    if (taken[s].empty()) continue;
    std::vector<std::uint32_t> start;
    for (const std::uint32_t first : world.sets[s].block_start)
      start.push_back(
          static_cast<std::uint32_t>(std::lower_bound(taken[s].begin(), taken[s].end(), first) - taken[s].begin()));
    sets_[s].taken.upload(taken[s]), sets_[s].taken_start.upload(start);
  }
}

SortInput ParticleSort::input(const SetMemory& set, const SetRoom& room) const {
  SortInput in{{set.now.u[0].data(), set.now.u[1].data(), set.now.u[2].data()},
               set.block_start.data(),
               room.taken.data(),
               room.taken_start.data(),
               {}};
  std::copy(alike_.begin(), alike_.end(), in.alike);
  return in;
}

/// Asks the device how many particles move where, for the plan.
void ParticleSort::count_moves(World<float>& world, Memory& memory) {
  plan_.begin(world);
  alike_ = first_alike(world);
  const std::size_t blocks = plan_.old_blocks().size(), sets = world.sets.size();
  moves_.resize(sets * blocks * ways);
  for (std::size_t s = 0; s < sets; ++s)
    launch(*device_, CountMoves{input(memory.sets[s], sets_[s]), moves_.data() + s * blocks * ways}, blocks);
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
    launch(*device_, Fill<std::int32_t>{room.counts.data(), static_cast<std::int64_t>(cells), 0},
           blocks_for<Fill<std::int32_t>>(cells));
    launch(*device_, CountCells{input(set, room), {targets_.data()}, room.counts.data(), room.number.data()}, old);
    launch(*device_,
           StartCells{room.counts.data(), set.next_block_start.data(), room.start.data(), cells_.data(), s == 0},
           blocks);
  }
  resize_for_overwrite(halves_, cells_.size());
  cells_.download(halves_);
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
         FillPlaces{input(memory, room), {targets_.data()}, room.start.data(), room.number.data(), room.from.data()},
         plan_.old_blocks().size());
  launch(*device_, SortPlaces{room.start.data(), memory.next_block_start.data(), room.from.data()}, blocks);
  const bool own = set.has_own_velocity();
  launch(*device_, MoveParticles{room.from.data(), static_cast<std::uint32_t>(size), memory.to_next(own)},
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

}  // namespace dreampm::gpu
