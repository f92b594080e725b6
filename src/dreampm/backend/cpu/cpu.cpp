#include "dreampm/backend/cpu/cpu.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "dreampm/backend/common.h"
#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/backend/cpu/node_kernel.h"
#include "dreampm/backend/cpu/turns.h"
#include "dreampm/backend/flush_to_zero.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/refit.h"

namespace dreampm {
namespace {

// The part of an arena axis that lies in the block before, in the block itself and in the one after.
struct Span {
  int side, first, count, at;
};
constexpr Span spans[3] = {{0, 3, 1, 0}, {1, 0, 4, 1}, {2, 0, 3, 5}};

// Where the eight nodes of an arena row along z lie in the grid: one, four and three of three blocks.
struct GridRow {
  std::size_t before, here, after;
};

// Calls body(row in the grid, index of its first node in the arena) for every row of nodes along z.
template <class Body>
void for_arena_rows(const Neighbours& around, const Body& body) {
  for (const Span& x : spans)
    for (const Span& y : spans) {
      const std::int32_t* const blocks = &around[static_cast<std::size_t>((x.side * 3 + y.side) * 3)];
      for (int i = 0; i < x.count; ++i)
        for (int j = 0; j < y.count; ++j) {
          const auto node = [&](int block, int k) {
            return static_cast<std::size_t>(blocks[block]) * block_nodes +
                   static_cast<std::size_t>(node_index(x.first + i, y.first + j, k));
          };
          body(GridRow{node(0, 3), node(1, 0), node(2, 0)},
               static_cast<std::size_t>(((x.at + i) * arena_width + y.at + j) * arena_width));
        }
    }
}

template <class T>
void load(const Neighbours& around, const std::vector<T>& nodes, T* arena) {
  for_arena_rows(around, [&](const GridRow& from, std::size_t to) {
    arena[to] = nodes[from.before];
    for (std::size_t k = 0; k < 4; ++k) arena[to + 1 + k] = nodes[from.here + k];
    for (std::size_t k = 0; k < 3; ++k) arena[to + 5 + k] = nodes[from.after + k];
  });
}
template <class T, class Add>
void store(const Neighbours& around, const Node<float>* arena, std::vector<T>& nodes, const Add& add) {
  for_arena_rows(around, [&](const GridRow& to, std::size_t from) {
    add(nodes[to.before], arena[from]);
    for (std::size_t k = 0; k < 4; ++k) add(nodes[to.here + k], arena[from + 1 + k]);
    for (std::size_t k = 0; k < 3; ++k) add(nodes[to.after + k], arena[from + 5 + k]);
  });
}
void store(const Neighbours& around, const Node<float>* arena, std::vector<Node<float>>& nodes) {
  store(around, arena, nodes, [](Node<float>& node, const Node<float>& given) { node = node + given; });
}
/// Of the liquid channel, as a kernel gives it.
void store(const Neighbours& around, const Node<float>* arena, std::vector<LiquidNode<float>>& nodes) {
  store(around, arena, nodes, [](LiquidNode<float>& node, const Node<float>& given) {
    node.blocked += given.x;
    node.viscosity += given.y;
  });
}

/// Nodes that a kernel adds to, four at a time: some before the first and one after the last, which get nothing. The
/// second of a row, where most of its fours begin, lies on a cache line.
struct Given {
  alignas(64) Node<float> room[3 + arena_nodes + 1];
  Node<float>* nodes() { return room + 3; }
  void clear() { std::fill(std::begin(room), std::end(room), Node<float>{}); }
};

struct Arena {
  // By field.
  alignas(64) Node<float> in[2][arena_nodes], before_in[2][arena_nodes];
  LiquidNode<float> liquid_in[arena_nodes];
  Given out[2], before_out[2], liquid_out;
};

/// What a block costs before its first particle, in particles: loading and storing the arena.
constexpr std::uint32_t block_work = 48;

/// Arenas that passes borrow.
class ArenaPool {
 public:
  /// Makes as many as there are threads to work in them, so that a pass takes no memory.
  void prepare(std::size_t threads) {
    while (free_.size() < threads) free_.push_back(std::make_unique<Arena>());
  }
  std::unique_ptr<Arena> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Arena>();
    std::unique_ptr<Arena> arena = std::move(free_.back());
    free_.pop_back();
    return arena;
  }
  void give(std::unique_ptr<Arena> arena) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(arena));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Arena>> free_;
};

NodeLoops<float> node_loops_of(std::string_view isa) {
#if defined(__x86_64__)
  return isa == "avx512" ? avx512::node_loops() : isa == "avx2" ? avx2::node_loops() : sse4::node_loops();
#else
  return neon::node_loops();
#endif
}

class Cpu final : public Backend<float> {
 public:
  explicit Cpu(const KernelTable& table) : table_(table), update_(node_loops_of(table.isa)) {}
  std::string_view name() const override { return "cpu"; }
  std::string_view isa() const override { return table_.isa; }

  void adopt(const World<float>& world) override {
    obstacles_ = {};
    sets_.clear();
    refresh(world);
  }

  void sort(World<float>& world) override {
    regroup_(world, next_);
    refresh(world);
  }

  PassStats birth(World<float>& world, std::size_t set, std::span<const Newborn> newborns) override {
    insert(world, set, newborns);
    sets_.clear();
    refresh(world);
    return scatter_newborns(world, set, newborns, obstacles_);
  }

  GridStats grid_update(World<float>& world, double dt) override { return update_(world, obstacles_, dt); }

  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    fit_grid(world, next_);
    prepare_sets(world, dt, dt_next, motion);
    partial_.assign(world.particle_blocks.size(), KernelStats{});
    turns_.begin();
    work_together([&](Crew& crew) {
      const FlushToZero mode;
      crew.loop(world.grid.blocks.size(), 16, [&](std::size_t b) { clear_block(world, obstacles_, next_, b); });
      update_.images().weigh(crew, world);
      std::unique_ptr<Arena> arena = arenas_.take();
      turns_.run(crew, [&](std::size_t b) { block_pass(world, sets_, b, *arena); });
      arenas_.give(std::move(arena));
    });
    swap_fields(world.grid, next_);
    PassStats total;
    for (const KernelStats& s : partial_)
      total.add({s.wave_speed,
                 s.viscosity,
                 s.j_min,
                 s.j_max,
                 s.pushed,
                 s.finite,
                 {s.kinetic, s.elastic, s.viscous, s.plastic, s.relaxed}});
    return total;
  }

 private:
  struct SetPass {
    BlockPass pass{};
    Kernel kernel = nullptr;
    std::shared_ptr<const void> law;  ///< made once: a set's values do not change while it is adopted
    const std::vector<std::uint32_t>* block_start = nullptr;
  };

  // After every change of the block lists.
  void refresh(const World<float>& world) {
    arenas_.prepare(static_cast<std::size_t>(thread_count()));
    obstacles_.prepare(world);
    neighbours_of(world, around_);
    update_.prepare(world);
    // Arenas of blocks that are two apart on some axis, or more, share no node.
    refit(work_, world.particle_blocks.size());
    for (std::size_t b = 0; b < work_.size(); ++b) {
      work_[b] = block_work;
      for (const auto& set : world.sets) work_[b] += set.block_start[b + 1] - set.block_start[b];
    }
    turns_.prepare(world, world.particle_blocks, work_);
  }

  void prepare_sets(World<float>& world, double dt, double dt_next, Motion<float>* motion) {
    sets_.resize(world.sets.size());
    if (motion) motion->sets.assign(world.sets.size(), {});
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      ParticleSet<float>& set = world.sets[s];
      SetPass& p = sets_[s];
      p.pass = {};
      p.block_start = &set.block_start;
      p.pass.step = set_step(world, set, dt, dt_next);
      p.pass.liquid = set.liquid;
      for (std::size_t a = 0; a < 3; ++a) p.pass.u[a] = set.u[a].data();
      for (std::size_t a = 0; a < 3; ++a) p.pass.own[a] = set.transfer.keeps_velocity() ? set.own[a].data() : nullptr;
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
      p.pass.law = p.law.get();
      if (p.law) continue;
      int index = 0;
      Materials::for_each([&]<class M>() {
        if (M::info.name == set.material) {
          auto law = std::make_shared<typename M::template Law<float>>(M::template Law<float>::from(set.values));
          p.pass.law = law.get();
          p.law = law;
          p.kernel = table_.kernels[index];
        }
        ++index;
      });
    }
  }

  void block_pass(const World<float>& world, const std::vector<SetPass>& sets, std::size_t b, Arena& arena) {
    const bool channel = !world.grid.liquid.empty();
    const bool two_fields = !world.grid.solids.empty();
    bool used[2]{};
    for (const SetPass& s : sets)
      if ((*s.block_start)[b] < (*s.block_start)[b + 1]) used[two_fields && !s.pass.liquid] = true;
    for (std::size_t f = 0; f < 2; ++f)
      if (used[f]) {
        load(around_[b], f == 0 ? world.grid.nodes : world.grid.solids, arena.in[f]);
        arena.out[f].clear();
        if (world.grid.before[f].empty()) continue;
        load(around_[b], world.grid.before[f], arena.before_in[f]);
        arena.before_out[f].clear();
      }
    if (channel) {
      load(around_[b], world.grid.liquid, arena.liquid_in);
      arena.liquid_out.clear();
    }
    const BlockWalls<float> walls = block_walls(world, world.particle_blocks[b]);
    for (const SetPass& s : sets) {
      BlockPass pass = s.pass;
      pass.begin = (*s.block_start)[b];
      pass.end = (*s.block_start)[b + 1];
      if (pass.begin == pass.end) continue;
      pass.walls = walls;
      const int field = two_fields && !pass.liquid;
      pass.in = arena.in[field];
      pass.out = arena.out[field].nodes();
      pass.liquid_in = channel ? arena.liquid_in : nullptr;
      pass.liquid_out = channel ? arena.liquid_out.nodes() : nullptr;
      pass.before_in = pass.own[0] ? arena.before_in[field] : nullptr;
      pass.before_out =
          world.grid.before[static_cast<std::size_t>(field)].empty() ? nullptr : arena.before_out[field].nodes();
      s.kernel(pass, partial_[b]);
    }
    if (used[0]) store(around_[b], arena.out[0].nodes(), next_.nodes);
    if (used[1]) store(around_[b], arena.out[1].nodes(), next_.solids);
    if (channel) store(around_[b], arena.liquid_out.nodes(), next_.liquid);
    for (std::size_t f = 0; f < 2; ++f)
      if (used[f] && !next_.before[f].empty()) store(around_[b], arena.before_out[f].nodes(), next_.before[f]);
  }

  const KernelTable& table_;
  Obstacles obstacles_;
  Regroup<float> regroup_;
  GridUpdate<float> update_;
  ArenaPool arenas_;
  std::vector<SetPass> sets_;  ///< of the pass, kept for its room
  std::vector<Neighbours> around_;
  Turns turns_;
  std::vector<std::uint32_t> work_;  ///< of the turns, in particles
  Carried<float> next_;              ///< its block list stays empty
  std::vector<KernelStats> partial_;
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

std::unique_ptr<Backend<float>> make_cpu_backend(std::string_view isa) { return std::make_unique<Cpu>(table_of(isa)); }

}  // namespace dreampm
