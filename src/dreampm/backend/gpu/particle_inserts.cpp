#include "dreampm/backend/gpu/particle_inserts.h"

#include <algorithm>
#include <utility>

#include "dreampm/backend/gpu/launch.h"
#include "dreampm/backend/gpu/memory_need.h"
#include "dreampm/backend/scatter_particles.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/world_fields.h"

namespace dreampm::gpu {
namespace {

/// Gives all columns of a set `size` rows; those that are there stay. `room`: as
/// InsertPlan::room().
void resize_columns(ParticleSet<float>& set, std::size_t size, std::size_t room) {
  Materials::with(set.material, [&]<class M>() { set.state.resize(state_columns<M>); });
  visit_fields(set, [&]<class F>(const F& field, auto& member) {
    if constexpr (F::use.carried)
      if (field.needed(set)) visit_columns(member, [&](auto& column) { column.reserve(room), column.resize(size); });
  });
}

}  // namespace

ParticleInserts::ParticleInserts(Device& device, GridLayout& layout, SomeNodes& nodes)
    : device_(&device), layout_(layout), nodes_(nodes), placed_(device), cells_(device), filled_(device) {}

void ParticleInserts::begin(World<float>& world, Memory& memory, std::size_t set, std::span<const ParticleSeed> seeds) {
  plan_.emplace(world, set, seeds);
  set_ = set, seeds_ = seeds;
  ParticleSet<float>& to = world.sets[set];
  const std::size_t before = to.size(), columns = to.state.size(), size = plan_->start().back();
  std::vector<std::uint64_t> cells;
  if (!(world.drift > 0)) download_cells(world, memory);
  const std::vector<Vec3i> old_blocks = world.particle_blocks;
  laid_ = false;
  plan_->exchange(world);
  try {
    resize_columns(to, size, plan_->room());
    if (world.drift > 0)
      cells.assign(world.particle_blocks.size(), ~std::uint64_t{0});
    else
      cells = held_cells(world, halves_, old_blocks);
    laid_ = layout_.lay(world, cells);
    check_room(*device_, world);
  } catch (...) {
    if (laid_) layout_.take_back(world);
    resize_columns(to, before, 0);
    to.state.resize(columns);
    plan_->exchange(world);
    throw;
  }
}

/// Fills halves_: the cells that have particles, of the blocks before.
void ParticleInserts::download_cells(const World<float>& world, Memory& memory) {
  const std::size_t blocks = world.particle_blocks.size();
  cells_.resize(2 * blocks);
  halves_.assign(2 * blocks, 0);
  bool first = true;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    if (world.sets[s].size() == 0) continue;
    const SetMemory& set = memory.sets[s];
    launch(*device_,
           HoldCells{{set.now.u[0].data(), set.now.u[1].data(), set.now.u[2].data()},
                     set.block_start.data(),
                     cells_.data(),
                     first},
           blocks);
    first = false;
  }
  if (!first) cells_.download(halves_);
}

/// The cells that have particles or seeds, as GridTopology takes them. `halves`: those of old
/// blocks.
std::vector<std::uint64_t> ParticleInserts::held_cells(const World<float>& world,
                                                       const std::vector<std::uint32_t>& halves,
                                                       const std::vector<Vec3i>& old_blocks) const {
  std::vector<std::uint64_t> cells(world.particle_blocks.size(), 0);
  const std::vector<std::uint64_t> before = cells_from(halves);
  for (std::size_t b = 0, old = 0; b < cells.size() && old < before.size(); ++b)
    if (world.particle_blocks[b] == old_blocks[old]) cells[b] = before[old++];
  for (std::size_t i = 0; i < seeds_.size(); ++i)
    cells[plan_->blocks()[i]] |= std::uint64_t{1} << held_cell(plan_->places()[i].at);
  return cells;
}

void ParticleInserts::place(World<float>& world, Memory& memory) {
  ParticleSet<float>& set = world.sets[set_];
  SetMemory& to = memory.sets[set_];
  for (std::size_t s = 0; s < world.sets.size(); ++s) memory.sets[s].block_start.upload(world.sets[s].block_start);
  to.next_block_start.upload(plan_->start());
  const std::size_t size = plan_->start().back();
  const bool own = set.has_own_velocity();
  to.now.fit_state(set.state.size());
  to.next.resize(size, own, set.state.size());
  to.next_id.resize(size);
  launch(*device_, OpenColumns{to.block_start.data(), to.next_block_start.data(), to.to_next(own)},
         world.particle_blocks.size());
  std::swap(to.now, to.next);
  std::swap(to.id, to.next_id);
  std::swap(to.block_start, to.next_block_start);
  set.block_start = std::move(plan_->start());
  place_seeds(set, to);
  if (laid_) layout_.carry(world, memory);
}

void ParticleInserts::place_seeds(const ParticleSet<float>& set, SetMemory& memory) {
  PlaceSeeds kernel{
      nullptr,         0, static_cast<std::uint32_t>(set.state.size()), {}, memory.now.pointers(set.has_own_velocity()),
      memory.id.data()};
  Materials::with(set.material, [&]<class M>() {
    for (int c = 0; c < state_columns<M>; ++c) kernel.rest[c] = M::template State<float>::rest[c];
  });
  for (std::size_t begin = 0; begin < seeds_.size(); begin += seeds_at_once) {
    const std::size_t count = std::min(seeds_at_once, seeds_.size() - begin);
    placed_home_.resize(count);
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t i = begin + n;
      const Vec3<float> at = plan_->places()[i].at, own = static_cast<Vec3<float>>(seeds_[i].velocity);
      placed_home_[n] = {plan_->numbers()[i], seeds_[i].id, {at.x, at.y, at.z}, {own.x, own.y, own.z}};
    }
    placed_.upload(placed_home_);
    kernel.seeds = placed_.data(), kernel.count = static_cast<std::uint32_t>(count);
    launch(*device_, kernel, blocks_for<PlaceSeeds>(count));
  }
}

PassStats ParticleInserts::scatter(World<float>& world, Memory& memory, const Obstacles& obstacles,
                                   const std::vector<StencilBlocks>& stencil_blocks) {
  std::vector<bool> reached(world.grid.blocks.size());
  std::vector<std::uint32_t> of_seeds = plan_->blocks(), blocks;
  std::sort(of_seeds.begin(), of_seeds.end());
  of_seeds.erase(std::unique(of_seeds.begin(), of_seeds.end()), of_seeds.end());
  for (const std::uint32_t b : of_seeds)
    for (const std::int32_t g : stencil_blocks[b])
      if (g != BlockList::none) reached[static_cast<std::size_t>(g)] = true;
  const std::vector<std::uint32_t> empty = empty_at_colliders(world, memory, obstacles);
  for (const std::uint32_t b : empty) reached[b] = true;
  for (std::size_t b = 0; b < reached.size(); ++b)
    if (reached[b]) blocks.push_back(static_cast<std::uint32_t>(b));
  nodes_.choose(std::move(blocks));

  const NodesToAddTo<float> to = nodes_to_add_to(world, world.sets[set_]);
  const auto each_target = [&](const auto& body) {
    for (std::size_t t = 0; t < targets; ++t) {
      const Nodes<float>& field = host_field(world.grid, t);
      if (field.empty()) continue;
      for (const Node<float>* one : {to.own, to.stress, to.velocity_old, to.mixture})
        if (one == field.data()) body(t);
    }
  };
  each_target([&](std::size_t t) { nodes_.download(world, memory, t); });
  for (const std::uint32_t b : empty)
    add_colliders(world, obstacles, b, world.grid.mixture.data() + std::size_t{b} * block_nodes);
  const PassStats stats = add_seeds(world, set_, seeds_);
  each_target([&](std::size_t t) { nodes_.upload(world, memory, t); });
  plan_.reset(), seeds_ = {};
  return stats;
}

/// The blocks at colliders whose mixture is all zero: they are new.
std::vector<std::uint32_t> ParticleInserts::empty_at_colliders(World<float>& world, Memory& memory,
                                                               const Obstacles& obstacles) {
  std::vector<std::uint32_t> empty;
  if (world.grid.mixture.empty() || !obstacles.any()) return empty;
  const std::size_t blocks = world.grid.blocks.size();
  filled_.resize(blocks);
  launch(*device_, FindEmptyBlocks{memory.nodes[mixture_share].data(), filled_.data()}, blocks);
  resize_for_overwrite(filled_home_, blocks);
  filled_.download(filled_home_);
  for (std::size_t b = 0; b < blocks; ++b)
    if (filled_home_[b] == 0 && !obstacles.at(b).empty()) empty.push_back(static_cast<std::uint32_t>(b));
  return empty;
}

}  // namespace dreampm::gpu
