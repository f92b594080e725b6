#include "dreampm/backend/cpu/cpu.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include "dreampm/backend/common.h"
#include "dreampm/backend/cpu/colored_scheduler.h"
#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/backend/flush_to_zero.h"
#include "dreampm/backend/scatter_particles.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

struct Arena {
  BlockSplines in[2], velocity_old_in[2], mixture_in, clearance_in;  ///< by field, of one block at a time
  ArenaSums out[2], velocity_old_out[2], stress_out[2], mixture_out;
};

/// The check covers all materials, also those from outside of this tree.
template <class... M>
constexpr bool columns_fit(MaterialList<M...>) {
  return ((state_columns<M> <= most_state_columns) && ...);
}
static_assert(columns_fit(Materials{}), "a material has more columns of state than BlockPass::state holds");

/// The fixed cost of a block, in particles: that of loading and storing the arena.
constexpr std::uint32_t block_work = 48;

/// Arenas that passes borrow.
class ArenaPool {
 public:
  /// Makes as many as there are threads to work in them, so that a pass takes no memory.
  void prepare(std::size_t threads) {
    if (free_.size() < threads) make(threads - free_.size());
  }
  Arena& take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) make(1);
    Arena& arena = *free_.back();
    free_.pop_back();
    return arena;
  }
  void give(Arena& arena) {
    const std::lock_guard lock(mutex_);
    free_.push_back(&arena);
  }
  /// All, which must be back.
  void drop() { free_.clear(), made_.clear(); }

 private:
  void make(std::size_t count) {
    for (Arena& arena : made_.emplace_back(count)) free_.push_back(&arena);
  }

  std::mutex mutex_;
  std::vector<LargeVector<Arena, 0>> made_;  ///< on large pages, however few
  std::vector<Arena*> free_;
};

class Cpu final : public Backend<float> {
 public:
  explicit Cpu(const KernelTable& table) : table_(table), update_(table.node_loops()) {}
  std::string_view name() const override { return "cpu"; }
  std::string_view isa() const override { return table_.isa; }

  void attach(const World<float>& world) override {
    obstacles_.forget();
    sets_.clear();
    // Rows that a pass does not fit may hold numbers of another world; they are multiplied by zero,
    // and so must be finite.
    arenas_.drop();
    refresh(world);
  }

  void sort(World<float>& world) override {
    regroup_(world, next_);
    refresh(world);
  }

  void colliders_moved(const World<float>& world) override {
    obstacles_.prepare(world);
    update_.colliders_moved(world, obstacles_);
  }

  PassStats insert_particles(World<float>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    insert(world, set, seeds);
    sets_.clear();
    refresh(world);
    return scatter_seeds(world, set, seeds, obstacles_);
  }

  PassStats state_bounds(const World<float>& world) override { return dreampm::state_bounds(world); }

  void scatter_particles(World<float>& world, const Motion<float>& motion) override {
    sets_.clear();
    dreampm::scatter_particles(world, motion, obstacles_);
  }

  GridStats grid_update(World<float>& world, double dt) override { return update_(world, obstacles_, dt); }

  double sub_cycle(World<float>& world, double dt, GridStats& found) override {
    fit_grid(world, next_);
    prepare_sets(world, dt, dt, nullptr);
    const auto forces = [&] {
      pass_over(world, Task::viscosity, [&](ThreadTeam& team) {
        team.loop(unwritten_.size(), 64, [&](std::size_t i) { clear(world, Task::viscosity, unwritten_[i]); });
      });
    };
    const auto fastest = [&] {
      pass_over(world, Task::speed, [](ThreadTeam&) {});
      float fastest2 = 0;
      for (const PencilResult& r : partial_) fastest2 = std::max(fastest2, r.speed2);
      return std::sqrt(static_cast<double>(fastest2));
    };
    return update_.sub_cycle(world, obstacles_, dt, found, next_, forces, fastest);
  }

  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    fit_grid(world, next_);
    prepare_sets(world, dt, dt_next, motion);
    pass_over(world, Task::step, [&](ThreadTeam& team) {
      team.loop(unwritten_.size(), 16, [&](std::size_t i) { clear(world, Task::step, unwritten_[i]); });
      update_.images().add_image_mass(team, world, dt);
    });
    update_.gaps().set_measured();
    swap_fields(world.grid, next_);
    PassStats total;
    for (const PencilResult& r : partial_) total.add(r.stats);
    return total;
  }

 private:
  /// The task of a pass over the particles.
  enum class Task { step, viscosity, speed };

  struct SetPass {
    BlockPass pass{};
    Kernel kernel = nullptr;
    ViscousKernel viscous = nullptr;
    bool weighs = false;              ///< true if its particles gather mass
    std::shared_ptr<const void> law;  ///< made once: values change only before scatter_particles
    const std::vector<std::uint32_t>* block_start = nullptr;
    std::array<LargeVector<float>, 4> distance;  ///< as in BlockPass; empty without thin walls
    std::vector<LaneGroup> lane_groups;          ///< of the vectors of each block, from lane_groups_at on
    std::size_t lane_groups_at(std::size_t block, int lanes) const {
      return (*block_start)[block] / static_cast<std::size_t>(lanes) + block;
    }
  };

  /// The result of a pass in one pencil of blocks.
  struct PencilResult {
    PassStats stats;
    float speed2 = 0;  ///< of SpeedKernel [m^2/s^2]
  };

  /// Facts about a block from the last pass since the last sort, for the next pass.
  struct BlockHistory {
    Extent extent;   ///< of its particles; unknown before the first pass, as their lane groups are
    int beside = 1;  ///< the axis along which its splines shall lie side by side
  };

  // After every change of the block lists.
  void refresh(const World<float>& world) {
    arenas_.prepare(static_cast<std::size_t>(thread_count()));
    obstacles_.prepare(world);
    find_stencil_blocks(world, stencil_blocks_);
    update_.prepare(world, obstacles_);
    history_.assign(world.particle_blocks.size(), {});
    // Pencils of blocks along z, each one task: arenas of two that are two blocks apart on x or y
    // share no node.
    const std::vector<Vec3i>& blocks = world.particle_blocks;
    pencils_.clear(), places_.clear(), work_.clear();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const Vec3i place{blocks[b].x, blocks[b].y, 0};
      if (places_.empty() || !(places_.back() == place))
        pencils_.push_back(b), places_.push_back(place), work_.push_back(0);
      work_.back() += block_work;
      for (const auto& set : world.sets) work_.back() += set.block_start[b + 1] - set.block_start[b];
    }
    pencils_.push_back(blocks.size());
    scheduler_.prepare(world, places_, work_);
    find_first_writers(world.grid.blocks.size());
  }

  /// Finds the first task (in color order) that writes each grid block; that task zeroes it.
  void find_first_writers(std::size_t grid_blocks) {
    resize_for_overwrite(first_writes_, stencil_blocks_.size());
    claimed_.assign(grid_blocks, false);
    for (const std::uint32_t task : scheduler_.by_color())
      for (std::size_t b = pencils_[task]; b < pencils_[task + 1]; ++b) {
        first_writes_[b] = 0;
        for (std::size_t n = 0; n < stencil_blocks_[b].size(); ++n) {
          const std::int32_t g = stencil_blocks_[b][n];
          if (g != BlockList::none && !std::exchange(claimed_[static_cast<std::size_t>(g)], true))
            first_writes_[b] |= static_cast<std::uint8_t>(1u << n);
        }
      }
    unwritten_.clear();
    for (std::size_t g = 0; g < grid_blocks; ++g)
      if (!claimed_[g]) unwritten_.push_back(static_cast<std::uint32_t>(g));
  }
  /// Clears a block of the grid before a task adds to it.
  void clear(const World<float>& world, Task task, std::size_t block) {
    if (task == Task::step) {
      update_.gaps().clear_block(block);
      return clear_block(world, obstacles_, next_, block);
    }
    for (auto* field : {&next_.nodes, &next_.solids})
      if (!field->empty()) std::fill_n(field->data() + block * block_nodes, block_nodes, Node<float>{});
  }

  void prepare_sets(World<float>& world, double dt, double dt_next, Motion<float>* motion) {
    sets_.resize(world.sets.size());
    if (motion) motion->sets.resize(world.sets.size());  // whose memory serves again
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      ParticleSet<float>& set = world.sets[s];
      SetPass& p = sets_[s];
      p.pass = {};
      p.block_start = &set.block_start;
      resize_for_overwrite(p.lane_groups, p.lane_groups_at(world.particle_blocks.size(), table_.lanes));
      p.pass.step = set_step(world, set, dt, dt_next);
      p.pass.liquid = set.liquid;
      p.pass.own_field = world.field_of(set) == 1;
      p.pass.by_volume = world.measures_by_volume(world.field_of(set));
      for (std::size_t a = 0; a < 3; ++a) p.pass.u[a] = set.u[a].data();
      for (std::size_t a = 0; a < 3; ++a)
        p.pass.own_velocity[a] = set.transfer.keeps_velocity() ? set.own_velocity[a].data() : nullptr;
      for (std::size_t c = 0; c < set.state.size(); ++c) p.pass.state[c] = set.state[c].data();
      if (motion) {
        auto& m = motion->sets[s];
        m.velocity.resize(set.size()), m.gradient.resize(set.size());
        m.energy.resize(set.size()), m.volume_ratio.resize(set.size());
        p.pass.velocity = m.velocity.empty() ? nullptr : &m.velocity[0].x;
        p.pass.gradient = m.gradient.empty() ? nullptr : m.gradient[0].m;
        p.pass.energy = m.energy.data();
        p.pass.volume_ratio = m.volume_ratio.data();
      }
      for (auto& column : p.distance) resize_for_overwrite(column, obstacles_.any_thin() ? set.size() : 0);
      p.pass.law = p.law.get();
      const bool attached = p.law != nullptr;
      int index = 0;
      Materials::for_each([&]<class M>() {
        if (M::info.name == set.material) p.weighs = measures<M>(p.pass.step.volume_relaxation) && !p.pass.by_volume;
        if (M::info.name == set.material && !attached) {
          auto law = std::make_shared<typename M::template Law<float>>(M::template Law<float>::from(set.values));
          p.pass.law = law.get();
          p.law = law;
          p.kernel = table_.kernels[index];
          p.viscous = table_.viscous[index];
        }
        ++index;
      });
    }
  }

  /// One pass over all particles; `first` is what the threads do before.
  template <class First>
  void pass_over(const World<float>& world, Task task, const First& first) {
    resize_for_overwrite(partial_, places_.size());
    scheduler_.begin();
    parallel_region([&](ThreadTeam& team) {
      const FlushToZero mode;
      first(team);
      Arena& arena = arenas_.take();
      scheduler_.run(team, [&](std::size_t p) {
        PencilResult found;
        for (std::size_t b = pencils_[p]; b < pencils_[p + 1];) b = pass(world, task, b, arena, found);
        partial_[p] = found;
      });
      arenas_.give(arena);
    });
  }

  /// The blocks from `first` on that share an arena: neighbors along z. Which ones follows from
  /// absolute block numbers alone. Adds to `found` and returns the block after the last.
  std::size_t pass(const World<float>& world, Task task, std::size_t first, Arena& arena, PencilResult& found) {
    const bool whole = task == Task::step;
    const std::vector<Vec3i>& blocks = world.particle_blocks;
    std::size_t end = first + 1;
    while (end < blocks.size() && blocks[end] == blocks[end - 1] + Vec3i{0, 0, 1} && blocks[end].z % arena_blocks != 0)
      ++end;
    for (std::size_t b = first; b < end; ++b)
      if (!history_[b].extent.known()) history_[b].extent = measure_extent(b);
    ArenaPlace place{static_cast<int>(end - first) + 1, {}, reach_of(first, end)};
    for (std::size_t side = 0; side < 4; ++side) {
      std::int32_t* to = place.pencil[side];
      for (std::size_t b = first; b < end; ++b) *to++ = stencil_blocks_[b][side * 2];
      *to = stencil_blocks_[end - 1][side * 2 + 1];
    }
    const bool mixed = whole && !world.grid.mixture.empty();
    const auto kept = [&](std::size_t f) { return whole && !world.grid.velocity_old[f].empty(); };
    const auto takes_part = [&](const SetPass& s) { return task != Task::viscosity || s.viscous; };
    bool used[2]{}, weighed[2]{}, by_volume = false;
    for (const SetPass& s : sets_) {
      if ((*s.block_start)[first] == (*s.block_start)[end] || !takes_part(s)) continue;
      const std::size_t f = s.pass.own_field;
      used[f] = true, weighed[f] |= whole && s.weighs, by_volume |= s.pass.by_volume;
    }
    // Rows of the first block; where blocks follow each other in the grid's memory, those of the
    // others lie alike.
    std::int32_t rows[arena_rows];
    int row_count = 0;
    if (whole) place.for_rows(0, 1, [&](int, int, int node) { rows[row_count++] = node; });
    const ArenaLoops& loops = table_.loops;
    for (std::size_t b = first; b < end; ++b) {
      const bool colliders = whole && colliders_near(obstacles_, stencil_blocks_[b]);
      const BlockWalls<float> walls = block_walls(world, blocks[b], colliders);
      const std::size_t to = (b - first) * ArenaSums::block_step;
      const int beside = history_[b].beside;
      const ArenaReach reach = reach_of(b, b + 1);
      const auto fit = [&](ArenaLoops::Fit by, const Nodes<float>& field, BlockSplines& splines) {
        by(field.data(), place, static_cast<int>(b - first), reach, beside, splines.v.data());
      };
      for (std::size_t f = 0; f < 2; ++f) {
        if (!used[f]) continue;
        fit(weighed[f] ? loops.fit : loops.fit_three, world.grid.field(f), arena.in[f]);
        if (kept(f)) fit(loops.fit_three, world.grid.velocity_old[f], arena.velocity_old_in[f]);
      }
      if (mixed) fit(by_volume ? loops.fit_three : loops.fit_one, world.grid.mixture, arena.mixture_in);
      if (colliders) fit(loops.fit, obstacles_.clearance(), arena.clearance_in);
      const ThinWalls thin(obstacles_, stencil_blocks_[b]);
      BlockExtent there;
      for (SetPass& s : sets_) {
        BlockPass pass = s.pass;
        pass.begin = (*s.block_start)[b];
        pass.end = (*s.block_start)[b + 1];
        if (pass.begin == pass.end || !takes_part(s)) continue;
        pass.lane_groups = s.lane_groups.data() + s.lane_groups_at(b, table_.lanes);
        pass.walls = walls;
        const std::size_t field = pass.own_field;
        pass.beside = beside;
        const auto row_of = [&](const GridFields<float>& grid, std::size_t block) {
          return reinterpret_cast<std::uintptr_t>(grid.field(field).data()) +
                 (block - first) * block_nodes * sizeof(Node<float>);
        };
        // The lower half of what the next block gathers from is the upper half of what this one
        // does.
        pass.hints = {rows, row_count, b + 1 < end ? row_of(world.grid, b + 2) : 0, row_of(next_, b)};
        pass.in = arena.in[field].v.data();
        pass.out = arena.out[field].nodes() + to;
        pass.mixture_in = mixed ? arena.mixture_in.v.data() : nullptr;
        pass.clearance_in = colliders ? arena.clearance_in.v.data() : nullptr;
        pass.stress_out = whole && pass.step.sub_cycled ? arena.stress_out[field].nodes() + to : nullptr;
        pass.mixture_out = mixed ? arena.mixture_out.nodes() + to : nullptr;
        pass.velocity_old_in = whole && pass.own_velocity[0] ? arena.velocity_old_in[field].v.data() : nullptr;
        pass.velocity_old_out = whole && pass.own_velocity[0] ? arena.velocity_old_out[field].nodes() + to : nullptr;
        switch (task) {
          case Task::step:
            if (thin.any()) find_distances(thin, s, pass);
            s.kernel(pass, found.stats, there);
            break;
          case Task::viscosity:
            s.viscous(pass);
            break;
          case Task::speed:
            found.speed2 = std::max(found.speed2, table_.speed(pass));
        }
      }
      if (!whole) continue;
      history_[b].extent = there.extent;
      if (loops.side_by_side && there.wide[0] != there.wide[1])
        history_[b].beside = there.wide[0] > there.wide[1] ? 0 : 1;
    }
    if (task == Task::speed) return end;
    for (std::size_t b = first; b < end; ++b)
      for (std::uint32_t left = first_writes_[b]; left; left &= left - 1)
        clear(world, task,
              static_cast<std::size_t>(stencil_blocks_[b][static_cast<std::size_t>(std::countr_zero(left))]));
    for (std::size_t b = first; whole && b < end; ++b)
      update_.gaps().measure_block(b, world, obstacles_, {history_[b].extent.low, history_[b].extent.high});
    place.reach = reach_of(first, end);
    if (used[0]) loops.add(arena.out[0].nodes(), place, next_.nodes.data());
    if (used[1]) loops.add(arena.out[1].nodes(), place, next_.solids.data());
    if (mixed) loops.add(arena.mixture_out.nodes(), place, next_.mixture.data());
    for (std::size_t f = 0; f < 2; ++f)
      if (whole && used[f] && world.viscous_stages > 0)
        loops.add(arena.stress_out[f].nodes(), place, next_.stress[f].data());
    for (std::size_t f = 0; f < 2; ++f)
      if (used[f] && kept(f)) loops.add(arena.velocity_old_out[f].nodes(), place, next_.velocity_old[f].data());
    return end;
  }

  /// Fills the columns of a pass over one block.
  static void find_distances(const ThinWalls& thin, SetPass& set, BlockPass& pass) {
    thin.fill({pass.u[0], pass.u[1], pass.u[2]}, pass.begin, pass.end, set.distance);
    for (std::size_t c = 0; c < 4; ++c) pass.distance[c] = set.distance[c].data();
  }
  /// Measures the extent of a block's particles, and finds their lane groups.
  Extent measure_extent(std::size_t block) {
    Extent extent;
    for (SetPass& s : sets_) {
      const std::size_t begin = (*s.block_start)[block], count = (*s.block_start)[block + 1] - begin;
      table_.loops.measure_extent({s.pass.u[0] + begin, s.pass.u[1] + begin, s.pass.u[2] + begin}, count,
                                  s.lane_groups.data() + s.lane_groups_at(block, table_.lanes), extent);
    }
    return extent;
  }
  /// Returns the rows in reach of the particles of those blocks, which share an arena, by the
  /// particles' extents.
  ArenaReach reach_of(std::size_t first, std::size_t end) const {
    Extent all;
    ArenaReach reach;
    for (std::size_t b = first; b < end; ++b) {
      const Extent& own = history_[b].extent;
      for (int a = 0; a < 2; ++a) all.low[a] = min(all.low[a], own.low[a]), all.high[a] = max(all.high[a], own.high[a]);
      if (b == first) reach.first = first_node(own.low.z) < block_width;
      if (b + 1 == end) reach.last = first_node(own.high.z) + 2 >= block_width;
    }
    for (int a = 0; a < 2; ++a) reach.low[a] = first_node(all.low[a]), reach.high[a] = first_node(all.high[a]) + 2;
    return reach;
  }

  const KernelTable& table_;
  Obstacles obstacles_;
  Regroup<float> regroup_;
  GridUpdate<float> update_;
  ArenaPool arenas_;
  std::vector<SetPass> sets_;                  ///< of the pass, kept for its room
  std::vector<StencilBlocks> stencil_blocks_;  ///< by block of particles
  std::vector<std::uint8_t> first_writes_;     ///< which of those its arena is the first to write, a bit each
  std::vector<std::uint32_t> unwritten_;       ///< the grid's blocks that no particle comes to: images behind walls
  std::vector<std::uint8_t> claimed_;          ///< room for find_first_writers()
  ColoredScheduler scheduler_;
  std::vector<std::size_t> pencils_;   ///< the first block of each, and the end of the last
  std::vector<Vec3i> places_;          ///< of the pencils
  std::vector<std::uint32_t> work_;    ///< of the pencils, in particles
  GridFields<float> next_;             ///< its block list stays empty
  std::vector<PencilResult> partial_;  ///< by pencil
  std::vector<BlockHistory> history_;  ///< of the blocks
};

const KernelTable& table_of(std::string_view isa) {
  const KernelTables t = available_kernels();
  for (int i = t.count - 1; i >= 0; --i)
    if (isa == "auto" || isa == t.tables[i]->isa) return *t.tables[i];
  fail_input("instruction set {} cannot run on this machine; it has {}", isa, fmt::join(cpu_instruction_sets(), ", "));
}

}  // namespace

KernelTables available_kernels() {
  KernelTables t{};
#if defined(__x86_64__)
  t.tables[t.count++] = &sse4::kernel_table();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    t.tables[t.count++] = &avx2::kernel_table();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512cd"))
    t.tables[t.count++] = &avx512::kernel_table();
#else
  t.tables[t.count++] = &neon::kernel_table();
#endif
  return t;
}

std::vector<std::string_view> cpu_instruction_sets() {
  std::vector<std::string_view> names;
  const KernelTables t = available_kernels();
  for (int i = 0; i < t.count; ++i) names.push_back(t.tables[i]->isa);
  return names;
}

std::uint64_t run_multiply_adds(std::uint64_t count, std::string_view isa) {
  const KernelTable& table = table_of(isa);
  const auto round = static_cast<std::uint64_t>(2 * multiply_add_chains * table.lanes), rounds = count / round + 1;
  volatile float used = table.multiply_adds(rounds);
  static_cast<void>(used);
  return rounds * round;
}

std::unique_ptr<Backend<float>> make_cpu_backend(std::string_view isa) { return make_cpu_backend(table_of(isa)); }
std::unique_ptr<Backend<float>> make_cpu_backend(const KernelTable& kernels) { return std::make_unique<Cpu>(kernels); }

}  // namespace dreampm
