#include "dreampm/backend/contact_gap.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "dreampm/backend/common.h"
#include "dreampm/backend/wall_distance.h"
#include "dreampm/base/parallel.h"
#include "dreampm/math/four.h"
#include "dreampm/physics/transfer.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

constexpr float far_away = ContactGaps::none;
/// Cells: a mean is no less than the least, but for rounding.
constexpr auto out_of_reach = static_cast<float>(kernel_reach * (1 + 1e-4));

/// The plane of nodes of a wall.
template <class R>
std::int32_t plane_of_wall(const World<R>& world, int side) {
  return side % 2 == 0 ? world.low[axis_of(side)] : world.high[axis_of(side)];
}
/// The mean over a stencil of the gradient of the distance, and of the distance, four numbers at
/// once. `clearance`: of the blocks that a block of particles reaches; `first`: the node at which
/// the stencil begins, counted from the first of these.
template <class R>
Node<R> clearance_at(const std::array<const Node<float>*, 8>& clearance, const Vec3i& first,
                     const Stencil<R>& stencil) {
  static_assert(sizeof(Node<float>) == sizeof(Four<float>));
  std::array<std::size_t, 3> block_z, node_z;
  for (int k = 0; k < 3; ++k)
    block_z[static_cast<std::size_t>(k)] = static_cast<std::size_t>((first.z + k) >> 2),
    node_z[static_cast<std::size_t>(k)] = static_cast<std::size_t>((first.z + k) & 3);
  Four<R> mean{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3i row{first.x + i, first.y + j, 0};
      const std::size_t block = reached_at(row), node = node_at(row);
      for (std::size_t k = 0; k < 3; ++k) {
        Four<R> at;
        load_floats<R>(clearance[block + block_z[k]] + node + node_z[k], at);
        mean += at * stencil.weight(i, j, static_cast<int>(k));
      }
    }
  return {mean[0], mean[1], mean[2], mean[3]};
}
/// The minimum of several threads does not depend on their order. `alone`: no other thread lowers
/// that slot now.
template <class R>
void lower(float& slot, R to, bool alone) {
  const float gap = std::max(0.0f, static_cast<float>(to));
  if (alone) {
    slot = std::min(slot, gap);
    return;
  }
  std::atomic_ref<float> shared(slot);
  float now = shared.load(std::memory_order_relaxed);
  while (gap < now && !shared.compare_exchange_weak(now, gap, std::memory_order_relaxed)) {
  }
}

}  // namespace

template <class R>
void ContactGaps::prepare(const World<R>& world, const Obstacles& obstacles) {
  near_blocks_.clear(), walls_.clear(), near_block_of_.clear();
  measured_ = false;
  walls_of_.clear(), gaps_of_.clear();
  if (!world.settings.keep_inside) return;
  if (std::all_of(world.sets.begin(), world.sets.end(), [](const auto& s) { return s.liquid; })) return;
  const BlockList& blocks = world.grid.blocks;
  gaps_of_.assign(blocks.size(), -1);
  walls_of_.assign(blocks.size(), {-1, -1, -1, -1, -1, -1});
  std::array<bool, 6> closed;
  for (int side = 0; side < 6; ++side)
    closed[static_cast<std::size_t>(side)] = world.walls[static_cast<std::size_t>(side)].type != WallType::open;

  std::int32_t count = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    bool near = obstacles.any() && obstacles.near(b);
    for (int side = 0; side < 6; ++side)
      near = near ||
             (closed[static_cast<std::size_t>(side)] && blocks[b][axis_of(side)] == plane_of_wall(world, side) >> 2);
    if (near) gaps_of_[b] = count++;
  }
  cell_gaps_.assign(static_cast<std::size_t>(count), {});

  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int side = 0; side < 6; ++side) {
      const int a = axis_of(side);
      const std::int32_t plane = plane_of_wall(world, side),
                         last = side % 2 == 0 ? blocks[b][a] * 4 : blocks[b][a] * 4 + 3;
      if (!closed[static_cast<std::size_t>(side)] || (last - plane) * inward_of(side) > 0) continue;
      WallNodes wall{{}, side, plane & 3, {}};
      for (int n = 0; n < 4; ++n) {
        Vec3i at = blocks[b];
        at[a] = plane >> 2;
        at[(a + 1) % 3] -= n / 2, at[(a + 2) % 3] -= n % 2;
        const std::int32_t holder = blocks.find(world.wrapped(at));
        wall.from[static_cast<std::size_t>(n)] =
            holder == BlockList::none ? -1 : gaps_of_[static_cast<std::size_t>(holder)];
      }
      walls_of_[b][static_cast<std::size_t>(side)] = static_cast<std::int32_t>(walls_.size());
      walls_.push_back(wall);
    }

  near_block_of_.assign(world.particle_blocks.size(), -1);
  std::size_t count_near = 0;
  for (std::size_t b = 0; b < world.particle_blocks.size(); ++b) {
    if (std::none_of(world.sets.begin(), world.sets.end(),
                     [&](const auto& s) { return !s.liquid && s.block_start[b] < s.block_start[b + 1]; }))
      continue;
    const Vec3i& block = world.particle_blocks[b];
    NearBlock near_block{static_cast<std::uint32_t>(b), false, stencil_blocks_in(blocks, world, block), {}, 0};
    near_block.colliders = colliders_near(obstacles, near_block.stencil_blocks);
    bool near = near_block.colliders;
    for (int side = 0; side < 6; ++side) {
      const std::int32_t at = plane_of_wall(world, side) - block[axis_of(side)] * block_width;
      const bool reaches = closed[static_cast<std::size_t>(side)] && at >= 0 && at < 2 * block_width;
      near_block.plane[static_cast<std::size_t>(side)] = static_cast<std::int8_t>(reaches ? at : -1);
      near = near || reaches;
    }
    if (near_block.colliders) near_block.nodes = count_near++;
    if (!near) continue;
    near_block_of_[b] = static_cast<std::int32_t>(near_blocks_.size());
    near_blocks_.push_back(near_block);
  }
  resize_for_overwrite(near_nodes_, count_near);
  parallel_for(near_blocks_.size(), 4, [&](std::size_t b) {
    const NearBlock& near_block = near_blocks_[b];
    if (near_block.colliders) near_nodes_[near_block.nodes].find(near_block.stencil_blocks, obstacles);
  });
}

bool ContactGaps::reaches_colliders(const NearBlock& near_block, const Obstacles& obstacles) const {
  return near_block.colliders && (!(near_nodes_[near_block.nodes].nearest > out_of_reach) ||
                                  ThinWalls(obstacles, near_block.stencil_blocks).any());
}

void ContactGaps::clear_block(std::size_t block) {
  if (gaps_of_.empty() || gaps_of_[block] < 0) return;
  CellGaps& gaps = cell_gaps_[static_cast<std::size_t>(gaps_of_[block])];
  for (std::size_t side = 0; side < 6; ++side)
    if (std::exchange(gaps.any[side], std::uint8_t{0}) != 0) gaps.gap[side].fill(far_away);
}

template <class R>
void ContactGaps::measure(ThreadTeam& team, const World<R>& world, const Obstacles& obstacles) {
  if (near_blocks_.empty()) return;
  if (!measured_) {
    constexpr R anywhere(static_cast<R>(far_away));
    const Bounds<R> bounds{{-anywhere, -anywhere, -anywhere}, {anywhere, anywhere, anywhere}};
    team.loop(gaps_of_.size(), 64, [&](std::size_t block) { clear_block(block); });
    team.loop(near_blocks_.size(), 1,
              [&](std::size_t h) { measure_block(near_blocks_[h], world, obstacles, bounds, false); });
  }
  team.loop(walls_.size(), 16, [&](std::size_t w) { find_wall_gap(walls_[w]); });
}

template <class R>
void ContactGaps::measure_block(std::size_t block, const World<R>& world, const Obstacles& obstacles,
                                const Bounds<R>& bounds) {
  if (near_block_of_.empty() || near_block_of_[block] < 0) return;
  measure_block(near_blocks_[static_cast<std::size_t>(near_block_of_[block])], world, obstacles, bounds, true);
}

template <class R>
void ContactGaps::measure_block(const NearBlock& near_block, const World<R>& world, const Obstacles& obstacles,
                                const Bounds<R>& bounds, bool alone) {
  for (const ParticleSet<R>& set : world.sets) {
    if (set.liquid) continue;
    for (int side = 0; side < 6; ++side)
      if (near_block.plane[static_cast<std::size_t>(side)] >= 0)
        measure_wall(near_block, side, set, world.dx, bounds, alone);
    if (near_block.colliders) measure_colliders(near_block, set, world.dx, obstacles, alone);
  }
}

template <class R>
void ContactGaps::measure_wall(const NearBlock& near_block, int side, const ParticleSet<R>& set, double dx,
                               const Bounds<R>& bounds, bool alone) {
  const int a = axis_of(side), b = (a + 1) % 3, c = (a + 2) % 3,
            plane = near_block.plane[static_cast<std::size_t>(side)];
  const R inward(static_cast<R>(inward_of(side))),
      taken(static_cast<R>(ColliderContact::contact_gap * set.spacing() / dx));
  const std::uint32_t begin = set.block_start[near_block.block], end = set.block_start[near_block.block + 1];
  const R *x = set.u[static_cast<std::size_t>(a)].data(), *y = set.u[static_cast<std::size_t>(b)].data(),
          *z = set.u[static_cast<std::size_t>(c)].data();
  const WallDistance<R> wall(plane, side);
  const auto distance = [wall](R at) { return wall.of(at); };
  if (!(distance(inward > R(0) ? bounds.low[a] : bounds.high[a]) < R(kernel_reach))) return;
  // The nodes that a block reaches are two blocks wide. Their minima are shared with others once.
  // Neighbors in memory often have the same node: two tables, so that one does not wait for the
  // other.
  constexpr int width = 2 * block_width;
  std::array<std::array<R, width * width>, 2> least;
  least[0].fill(R(kernel_reach)), least[1].fill(R(kernel_reach));
  // Few particles are that near, and not in a row: which of 32 are is found without branches.
  constexpr std::uint32_t at_once = 32;
  static constexpr auto bit_of = [] {
    std::array<std::uint32_t, at_once> bits;
    for (std::uint32_t i = 0; i < at_once; ++i) bits[i] = 1u << i;
    return bits;
  }();
  for (std::uint32_t first = begin; first < end; first += at_once) {
    std::array<R, at_once> away;
    std::uint32_t near = 0;
    const std::uint32_t count = std::min(at_once, end - first);
    if (count == at_once) {
      for (std::uint32_t i = 0; i < at_once; ++i) away[i] = distance(x[first + i]);
    } else {
      for (std::uint32_t i = 0; i < count; ++i) away[i] = distance(x[first + i]);
      for (std::uint32_t i = count; i < at_once; ++i) away[i] = R(kernel_reach);
    }
    for (std::uint32_t i = 0; i < at_once; ++i)
      near |= (0u - static_cast<std::uint32_t>(away[i] < R(kernel_reach))) & bit_of[i];
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      R& slot = least[i & 1][static_cast<std::size_t>(first_node(y[first + i]) * width + first_node(z[first + i]))];
      slot = std::min(slot, away[i]);
    }
  }
  for (int quarter = 0; quarter < 4; ++quarter) {
    Vec3i corner;
    corner[a] = plane, corner[b] = quarter / 2 * block_width, corner[c] = quarter % 2 * block_width;
    float* const gaps = gap_slot(near_block, side, corner);
    if (!gaps) continue;
    for (int n = 0; n < plane_nodes; ++n) {
      const auto at = static_cast<std::size_t>((corner[b] + n / block_width) * width + corner[c] + n % block_width);
      const R away = std::min(least[0][at], least[1][at]);
      if (away < R(kernel_reach)) lower(gaps[node_in_plane(a, n)], away - taken, alone);
    }
  }
}

template <class R>
void ContactGaps::measure_colliders(const NearBlock& near_block, const ParticleSet<R>& set, double dx,
                                    const Obstacles& obstacles, bool alone) {
  const std::uint32_t begin = set.block_start[near_block.block], end = set.block_start[near_block.block + 1];
  const NearNodes& nodes = near_nodes_[near_block.nodes];
  const ThinWalls thin(obstacles, near_block.stencil_blocks);
  if (begin == end || (nodes.nearest > out_of_reach && !thin.any())) return;
  std::array<const Node<float>*, 8> clearance{};
  for (std::size_t b = 0; b < clearance.size(); ++b)
    if (const std::int32_t block = near_block.stencil_blocks[b]; block != BlockList::none)
      clearance[b] = obstacles.clearance().data() + static_cast<std::size_t>(block) * block_nodes;
  const R taken(static_cast<R>(ColliderContact::contact_gap * set.spacing() / dx));
  const auto lower_slot = [&](int side, const Vec3<R>& u, R distance) {
    if (!(distance < R(kernel_reach))) return;
    if (float* const gap = gap_slot(near_block, side, {first_node(u.x), first_node(u.y), first_node(u.z)}))
      lower(*gap, distance - taken, alone);
  };
  for (std::uint32_t p = begin; p < end; ++p) {
    const Vec3<R> u{set.u[0][p], set.u[1][p], set.u[2][p]};
    if (const std::optional<Node<R>> exact = thin.any() ? thin.at(u, kernel_reach) : std::nullopt) {
      lower_slot(side_like(Vec3<R>{exact->x, exact->y, exact->z}), u, exact->m);
      continue;
    }
    Vec3i first;
    for (int a = 0; a < 3; ++a) first[a] = static_cast<int>(round_int(u[a] - R(0.5))) + 1;
    if (nodes.least[NearNodes::index(first)] > out_of_reach) continue;
    const Stencil<R> stencil = make_stencil(u);
    const R distance = nodes.distance_at(first, stencil);
    if (!(distance < R(kernel_reach))) continue;
    const std::uint8_t sides = nodes.sides[NearNodes::index(first)];
    int side = std::countr_zero(sides);
    if (!std::has_single_bit(sides)) {
      const Node<R> away = clearance_at(clearance, first, stencil);
      side = side_like(Vec3<R>{away.x, away.y, away.z});
    }
    lower_slot(side, u, distance);
  }
}

float* ContactGaps::gap_slot(const NearBlock& near_block, int side, const Vec3i& node) {
  const std::int32_t block = near_block.stencil_blocks[reached_at(node)];
  const std::int32_t slots = block == BlockList::none ? -1 : gaps_of_[static_cast<std::size_t>(block)];
  if (slots < 0) return nullptr;
  CellGaps& gaps = cell_gaps_[static_cast<std::size_t>(slots)];
  std::atomic_ref<std::uint8_t> any(gaps.any[static_cast<std::size_t>(side)]);
  if (any.load(std::memory_order_relaxed) == 0) any.store(1, std::memory_order_relaxed);
  return gaps.gap[static_cast<std::size_t>(side)].data() + node_at(node);
}

const ContactGaps::SideGaps& ContactGaps::gaps_at(std::int32_t slots, int side) const {
  static constexpr auto nothing = [] {
    SideGaps gaps{};
    gaps.fill(far_away);
    return gaps;
  }();
  return any_at(slots, side) ? cell_gaps_[static_cast<std::size_t>(slots)].gap[static_cast<std::size_t>(side)]
                             : nothing;
}

std::uint16_t ContactGaps::closed(std::size_t block, int side) const {
  const WallGap* const gap = at_wall(block, side);
  unsigned nodes = 0;
  for (std::size_t n = 0; gap && n < gap->size(); ++n) nodes |= static_cast<unsigned>(!((*gap)[n] > 0)) << n;
  return static_cast<std::uint16_t>(nodes);
}

/// A node takes part in the stencils that begin at it or at one of the two before it along each
/// axis.
void ContactGaps::find_wall_gap(WallNodes& wall) const {
  const int a = axis_of(wall.side), b = (a + 1) % 3, c = (a + 2) % 3;
  wall.gap.fill(far_away);
  if (std::none_of(wall.from.begin(), wall.from.end(), [&](std::int32_t slots) { return any_at(slots, wall.side); }))
    return;
  constexpr int width = block_width + 2;
  std::array<float, width * width> all;
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < width; ++j) {
      const int row = i - 2, column = j - 2;
      const std::int32_t slots = wall.from[static_cast<std::size_t>((row < 0) * 2 + (column < 0))];
      Vec3i node;
      node[a] = wall.plane, node[b] = row & 3, node[c] = column & 3;
      all[static_cast<std::size_t>(i * width + j)] =
          gaps_at(slots, wall.side)[static_cast<std::size_t>(node_index(node.x, node.y, node.z))];
    }
  std::array<float, width * width> rows;
  least_of_three(all.data(), rows, width);
  least_of_three(rows.data(), all, 1);
  for (int n = 0; n < block_width * block_width; ++n)
    wall.gap[static_cast<std::size_t>(n)] = all[static_cast<std::size_t>(n / 4 * width + n % 4)];
}

#define DM_INSTANTIATE(R)                                                             \
  template void ContactGaps::prepare(const World<R>&, const Obstacles&);              \
  template void ContactGaps::measure(ThreadTeam&, const World<R>&, const Obstacles&); \
  template void ContactGaps::measure_block(std::size_t, const World<R>&, const Obstacles&, const Bounds<R>&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
