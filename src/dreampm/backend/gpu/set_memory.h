// The arrays of a World in a device's memory.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/backend/gpu/device.h"
#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/backend/motion.h"
#include "dreampm/backend/pass_stats.h"
#include "dreampm/state/neighbors.h"

namespace dreampm::gpu {

/// The fields of the grid that particles give to, in the order of the arenas; those of the solids'
/// field are one further.
enum Target : std::size_t { nodes, solids, old_nodes, old_solids, stress_nodes, stress_solids, mixture_share, targets };
constexpr std::size_t of_field(Target first, std::size_t field) { return first + field; }
/// The field that decides the units of a target, as SumArenas takes it.
constexpr int unit_field(std::size_t target) { return target == mixture_share ? 2 : static_cast<int>(target % 2); }
inline Nodes<float>& host_field(GridFields<float>& grid, std::size_t target) {
  const std::size_t f = target % 2;
  if (target == mixture_share) return grid.mixture;
  return target < old_nodes ? grid.field(f) : target < stress_nodes ? grid.velocity_old[f] : grid.stress[f];
}
/// The target whose nodes those are.
inline std::size_t target_of(GridFields<float>& grid, const Nodes<float>& nodes) {
  std::size_t t = 0;
  while (&host_field(grid, t) != &nodes) ++t;
  return t;
}

/// What the matter of a block of particles weighs and takes.
inline BlockLoad load_of(const World<float>& world, std::size_t block) {
  std::array<double, 2> mass{}, one_mass{};
  double volume = 0, one_volume = 0;
  for (const ParticleSet<float>& set : world.sets) {
    if (set.size() == 0) continue;
    const double count = set.block_start[block + 1] - set.block_start[block];
    const double cells = set.rest_volume / (world.dx * world.dx * world.dx);
    const std::size_t field = world.field_of(set);
    mass[field] += largest_weight * count * set.mass;
    volume += largest_weight * count * cells;
    one_mass[field] = std::max(one_mass[field], set.mass), one_volume = std::max(one_volume, cells);
  }
  for (std::size_t f = 0; f < 2; ++f) mass[f] = std::max(mass[f], one_mass[f]);
  volume = std::max(volume, one_volume);
  return {{static_cast<float>(mass[0]), static_cast<float>(mass[1])}, static_cast<float>(volume)};
}
/// The same numbers, eight a block.
inline std::vector<std::int32_t> flat(const std::vector<StencilBlocks>& all) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(8 * all.size());
  for (const StencilBlocks& blocks : all) numbers.insert(numbers.end(), blocks.begin(), blocks.end());
  return numbers;
}

/// What a pass reports of a set.
inline PassStats stats_of(const World<float>& world, const ParticleSet<float>& set, const BlockSums& sums) {
  PassStats stats;
  stats.wave_speed = sums.wave_speed, stats.viscosity = sums.viscosity;
  stats.j_min = sums.j_min, stats.j_max = sums.j_max;
  stats.pushed = sums.pushed;
  stats.finite = sums.finite;
  const double kinetic = sums.kinetic * set.mass, volume = set.rest_volume;
  stats.energy = {kinetic, set.transfer.keeps_velocity() ? kinetic : 0, sums.viscous * volume, sums.plastic * volume,
                  sums.relaxed * volume};
  stats.swollen = sums.swollen * volume;
  for (int a = 0; a < 3; ++a) {
    stats.shifted[a] = sums.shifted[a] * set.mass * world.dx;
    stats.turned[a] = sums.turned[a] * set.mass * world.dx;
  }
  return stats;
}

/// The columns of the particles of a set.
class SetColumns {
 public:
  explicit SetColumns(Device& device) : device_(&device) {
    for (int a = 0; a < 3; ++a) u.emplace_back(device), own_velocity.emplace_back(device);
  }
  std::vector<Buffer<float>> u, own_velocity, state;

  /// Makes all as long as those of `other`.
  void fit(const SetColumns& other) { fit(u, other.u), fit(own_velocity, other.own_velocity), fit(state, other.state); }
  /// As many columns of state as the World has.
  void fit_state(std::size_t columns) {
    while (state.size() < columns) state.emplace_back(*device_);
    while (state.size() > columns) state.pop_back();
  }
  /// `own`: whether there are velocities of their own; `columns`: of state. Contents are undefined
  /// after it.
  void resize(std::size_t size, bool own, std::size_t columns) {
    fit_state(columns);
    for (Buffer<float>& column : u) column.resize(size);
    for (Buffer<float>& column : own_velocity) column.resize(own ? size : 0);
    for (Buffer<float>& column : state) column.resize(size);
  }
  /// Leaves the last rows out.
  void shorten(std::size_t size) {
    const auto shorten = [size](std::vector<Buffer<float>>& all) {
      for (Buffer<float>& column : all)
        if (column.size() > size) column.resize(size);
    };
    shorten(u), shorten(own_velocity), shorten(state);
  }
  ParticleColumns pointers(bool own) const {
    ParticleColumns to{};
    for (std::size_t a = 0; a < 3; ++a)
      to.u[a] = u[a].data(), to.own_velocity[a] = own ? own_velocity[a].data() : nullptr;
    for (std::size_t c = 0; c < state.size(); ++c) to.state[c] = state[c].data();
    return to;
  }

 private:
  void fit(std::vector<Buffer<float>>& to, const std::vector<Buffer<float>>& as) {
    while (to.size() < as.size()) to.emplace_back(*device_);
    while (to.size() > as.size()) to.pop_back();
    for (std::size_t c = 0; c < as.size(); ++c) to[c].resize(as[c].size());
  }
  Device* device_;
};

/// A set: its particles as they are, room for what a pass makes of them, and what it looks at.
class SetMemory {
 public:
  explicit SetMemory(Device& device)
      : now(device),
        next(device),
        block_start(device),
        next_block_start(device),
        id(device),
        next_id(device),
        velocity_(device),
        gradient_(device),
        energy_(device),
        volume_ratio_(device) {
    for (int c = 0; c < 4; ++c) distance.emplace_back(device);
  }
  SetColumns now, next;
  Buffer<std::uint32_t> block_start, next_block_start;  ///< `next`: room for a sort
  Buffer<std::uint32_t> id, next_id;
  std::vector<Buffer<float>> distance;  ///< as PassInput::distance

  /// Takes over what a pass made. `own`: whether that has velocities of their own.
  void swap(bool own) {
    std::swap(now, next);
    if (!own) std::swap(now.own_velocity, next.own_velocity);
  }
  void upload_position(const ParticleSet<float>& set, std::size_t blocks) {
    for (std::size_t a = 0; a < 3; ++a) now.u[a].upload(set.u[a]);
    // A set without matter may have no starts yet.
    block_start.upload(set.size() == 0 ? std::vector<std::uint32_t>(blocks + 1, 0) : set.block_start);
  }
  void upload_state(const ParticleSet<float>& set) {
    now.fit_state(set.state.size());
    for (std::size_t c = 0; c < set.state.size(); ++c) now.state[c].upload(set.state[c]);
    for (std::size_t a = 0; a < 3; ++a) now.own_velocity[a].upload(set.own_velocity[a]);
  }
  void download_position(ParticleSet<float>& set) const {
    for (std::size_t a = 0; a < 3; ++a) now.u[a].download(set.u[a]);
  }
  void download_state(ParticleSet<float>& set) const {
    for (std::size_t c = 0; c < set.state.size(); ++c) now.state[c].download(set.state[c]);
    for (std::size_t a = 0; a < 3; ++a) now.own_velocity[a].download(set.own_velocity[a]);
  }

  /// Columns and ids, from `now` to `next`.
  MovedColumns to_next(bool own) const {
    return {static_cast<std::uint32_t>(now.state.size()), now.pointers(own), next.pointers(own), id.data(),
            next_id.data()};
  }

  /// Makes room for the motion of a pass.
  void fit_motion() {
    const std::size_t n = now.u[0].size();
    velocity_.resize(n), gradient_.resize(n), energy_.resize(n), volume_ratio_.resize(n);
  }
  /// The velocities of the last pass that kept its motion, in its order [m/s].
  const Buffer<Vec3<float>>& velocity() const { return velocity_; }
  /// Makes a pass write its motion there.
  void output_to(PassOutput& out) const {
    const bool any = energy_.size() > 0;
    out.velocity = any ? &velocity_.data()->x : nullptr, out.gradient = any ? gradient_.data()->m : nullptr;
    out.energy = energy_.data(), out.volume_ratio = volume_ratio_.data();
  }
  void download_motion(Motion<float>::Set& to) const {
    to.velocity.resize(velocity_.size()), to.gradient.resize(velocity_.size());
    to.energy.resize(velocity_.size()), to.volume_ratio.resize(velocity_.size());
    velocity_.download(to.velocity), gradient_.download(to.gradient);
    energy_.download(to.energy), volume_ratio_.download(to.volume_ratio);
  }

 private:
  Buffer<Vec3<float>> velocity_;
  Buffer<Mat3<float>> gradient_;
  Buffer<float> energy_, volume_ratio_;
};

/// Ranges that are one after the other, few enough that the host can add up what comes of them:
/// each of `least` entries or more, and at most `most` of them.
inline void add_ranges(std::uint32_t begin, std::uint32_t end, std::vector<Range>& to) {
  constexpr std::uint32_t least = 512, most = 48;
  const std::uint32_t count = std::min(most, (end - begin + least - 1) / least);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto at = [&](std::uint32_t n) {
      return begin + static_cast<std::uint32_t>(std::uint64_t{end - begin} * n / count);
    };
    to.push_back({at(i), at(i + 1)});
  }
}

/// For each block of the grid the arenas that hold its nodes, as SumArenas takes them: in the order
/// of the blocks of particles, and of their corners.
class SourceLists {
 public:
  explicit SourceLists(Device& device) : first(device), arena(device), corner(device) {}
  Buffer<std::uint32_t> first;
  Buffer<std::int32_t> arena, corner;

  void upload(const std::vector<StencilBlocks>& reached, std::size_t grid_blocks) {
    std::vector<std::uint32_t> begin(grid_blocks + 1, 0);
    for (const StencilBlocks& blocks : reached)
      for (const std::int32_t b : blocks)
        if (b != BlockList::none) ++begin[static_cast<std::size_t>(b) + 1];
    for (std::size_t b = 0; b < grid_blocks; ++b) begin[b + 1] += begin[b];
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    std::vector<std::int32_t> from(begin.back()), at(begin.back());
    for (std::size_t b = 0; b < reached.size(); ++b)
      for (std::size_t c = 0; c < reached[b].size(); ++c) {
        if (reached[b][c] == BlockList::none) continue;
        const std::uint32_t n = next[static_cast<std::size_t>(reached[b][c])]++;
        from[n] = static_cast<std::int32_t>(b), at[n] = static_cast<std::int32_t>(c);
      }
    first.upload(begin), arena.upload(from), corner.upload(at);
  }
};

/// All of a World.
class Memory {
 public:
  explicit Memory(Device& device)
      : sources(device),
        stencil_blocks(device),
        walls(device),
        beside(device),
        apart(device),
        loads(device),
        clearance(device),
        base(device),
        block_sums(device),
        totals(device),
        block_ranges(device),
        block_speeds(device),
        device_(&device) {
    for (int f = 0; f < 2; ++f) momenta.emplace_back(device);
    for (std::size_t t = 0; t < targets; ++t) nodes.emplace_back(device), arenas.emplace_back(device);
  }
  std::vector<SetMemory> sets;
  SourceLists sources;
  Buffer<std::int32_t> stencil_blocks;
  Buffer<BlockWalls<float>> walls;
  Buffer<std::uint32_t> beside, apart;  ///< blocks of particles that colliders are near, and others
  Buffer<BlockLoad> loads;
  Buffer<Node<float>> clearance, base;
  std::vector<Buffer<Node<float>>> nodes;    ///< by Target
  std::vector<Buffer<NodeCounts>> arenas;    ///< by Target
  std::vector<Buffer<Node<float>>> momenta;  ///< that viscous stress gives, by field
  Buffer<BlockSums> block_sums, totals;
  Buffer<Range> block_ranges;  ///< of block_sums, that are added up
  Buffer<float> block_speeds;

  GridPointers grid_pointers() {
    return {{nodes[Target::nodes].data(), nodes[solids].data()},
            {nodes[old_nodes].data(), nodes[old_solids].data()},
            nodes[mixture_share].data()};
  }
  void resize_sets(std::size_t count) {
    while (sets.size() < count) sets.emplace_back(*device_);
    while (sets.size() > count) sets.pop_back();
  }

 private:
  Device* device_;
};

}  // namespace dreampm::gpu
