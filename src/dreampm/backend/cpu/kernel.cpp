// One pass over the particles of a block. This file is built once per instruction set (DM_ISA) with
// its own flags; it must export nothing but its table (tools/check_kernels). Particles go through
// it a chunk at a time: their vectors gather from the grid with one particle a lane, since those
// that lie in one row along z pick from the same nodes; then they give back one particle after the
// other, four nodes a vector.
#include "dreampm/backend/cpu/kernel.h"

#include "dreampm/backend/cpu/gather.h"
#include "dreampm/backend/cpu/lane_stats.h"
#include "dreampm/backend/cpu/scatter.h"
#include "dreampm/math/lanes.h"
#include "dreampm/physics/materials.h"

static_assert(HWY_STATIC_TARGET == DM_HWY_TARGET,
              "Highway fell to another target than this file's flags are meant for");

namespace dreampm::DM_ISA {

NodeLoops<float> node_loops();  // node_kernel.cpp

namespace {

/// Writes what a frame or a probe asks for of the particles from `p` on.
DM_FN void write_output(const BlockPass& pass, std::size_t p, int n, const Vec3<F>& v, const Mat3<F>& gradient,
                        const F& energy, const F& volume_ratio) {
  alignas(64) float out[12][W];
  for (int a = 0; a < 3; ++a) v[a].store(out[a]);
  for (int k = 0; k < 9; ++k) gradient.m[k].store(out[3 + k]);
  store_first(energy, pass.energy + p, n);
  store_first(volume_ratio, pass.volume_ratio + p, n);
  for (int l = 0; l < n; ++l) {
    const std::size_t to = p + static_cast<std::size_t>(l);
    for (std::size_t a = 0; a < 3; ++a) pass.velocity[3 * to + a] = out[a][l];
    for (std::size_t k = 0; k < 9; ++k) pass.gradient[9 * to + k] = out[3 + k][l];
  }
}

/// Uninitialized memory for a T: clearing vectors that are filled later costs stores that nobody
/// reads.
template <class T>
union Uninitialized {
  T value;
  DM_FN Uninitialized() {}
};

int chunk_size(const BlockPass& pass, std::size_t first) {
  return static_cast<int>(pass.end - first < chunk ? pass.end - first : chunk);
}

/// Fetches the chunk from `first` on.
template <int columns>
DM_FN void fetch(const BlockPass& pass, std::size_t first) {
  constexpr int line = 16;
#pragma GCC unroll 4
  for (std::size_t p = first; p < first + chunk; p += line) {
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) __builtin_prefetch(pass.u[a] + p, 1);
#pragma GCC unroll 16
    for (int k = 0; k < columns; ++k) __builtin_prefetch(pass.state[k] + p, 1);
  }
}

/// Fetches rows of nodes, a share of them with every chunk of the block: all at once they would be
/// waited for.
class RowFetcher {
 public:
  explicit DM_FN RowFetcher(const BlockPass& pass)
      : hints_(pass.hints), share_(hints_.count / static_cast<int>((pass.end - pass.begin + chunk - 1) / chunk) + 1) {}
  DM_FN void fetch() {
    constexpr int l1 = 3, l2 = 2;
    for (const int end = std::min(next_ + share_, hints_.count); next_ < end; ++next_) {
      const std::size_t row = static_cast<std::size_t>(hints_.rows[next_]) * sizeof(Node<float>);
      if (hints_.from) __builtin_prefetch(reinterpret_cast<const void*>(hints_.from + row), 0, l1);
      __builtin_prefetch(reinterpret_cast<const void*>(hints_.to + row), 0, l2);
    }
  }

 private:
  const PrefetchHints hints_;
  int share_, next_ = 0;
};

/// True if a pass has no optional terms: its matter keeps no velocities, is alone on the grid, and
/// has no obstacles near.
bool is_plain(const BlockPass& pass) {
  return !pass.own_velocity[0] && !pass.velocity && !pass.mixture_in && !pass.stress_out && !pass.clearance_in &&
         !pass.step.sub_cycled && !pass.walls.colliders;
}
/// Says so where the compiler can see it: of a plain pass nothing changes.
DM_FN void make_plain(BlockPass& pass) {
  pass.own_velocity[0] = pass.velocity = nullptr;
  pass.mixture_in = pass.velocity_old_in = pass.clearance_in = nullptr;
  pass.mixture_out = pass.velocity_old_out = pass.stress_out = nullptr;
  pass.step.sub_cycled = pass.walls.colliders = false;
  pass.step.transfer.blend = 0;
}

/// `relaxes`: whether this step relaxes the volume of liquids. `plain`: as in is_plain; by far the
/// most passes are, and without the code of all others more of them stays in registers.
template <class M, bool relaxes, bool plain>
void run_step(const BlockPass& of, PassStats& stats, BlockExtent& there) {
  constexpr int columns = state_columns<M>;
  // Copies that no store can reach: else all that follows from them alone would be worked out for
  // every vector anew. For the same reason nothing below goes by reference to a function that is
  // not inlined, and loops over arrays are unrolled.
  BlockPass pass = of;
  if constexpr (plain) make_plain(pass);
  SetStep<float> step = pass.step;
  if constexpr (!relaxes) step.volume_relaxation = 0;
  const BlockWalls<float> walls = pass.walls;
  const auto law = *static_cast<const typename M::template Law<float>*>(pass.law);
  const Source source(pass);
  ScatterBuffer buffer;
  LaneStats found;
  LaneGroup* group = pass.lane_groups;
  int wide[2] = {};
  RowFetcher rows(pass);
  fetch<columns>(pass, pass.begin + chunk);
  for (std::size_t first = pass.begin; first < pass.end; first += chunk) {
    const int particles = chunk_size(pass, first);
    for (int at = 0; at < particles; at += W) {
      const int n = particles - at < W ? particles - at : W;
      const std::size_t p = first + static_cast<std::size_t>(at);
      Vec3<F> u;
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) u[a] = load_first(pass.u[a] + p, n);
      Uninitialized<G2PResult<F>> room;
      G2PResult<F>& g = room.value;
      if constexpr (plain)
        source.template gather_at<wants_of<M, relaxes>>(u, *group, g);
      else
        source.template gather_apart<wants_of<M, relaxes>>(u, *group, g);
      if (!plain && pass.distance[0]) {
        const F exact = load_first(pass.distance[3] + p, n);
        const auto is_given = exact < F(no_distance);
        for (int a = 0; a < 3; ++a)
          g.clearance_gradient[a] = select(is_given, load_first(pass.distance[a] + p, n), g.clearance_gradient[a]);
        g.clearance = select(is_given, exact, g.clearance);
      }
      if (pass.own_velocity[0])
        for (int a = 0; a < 3; ++a) g.own_velocity[a] = load_first(pass.own_velocity[a] + p, n);
      typename M::template State<F> state;
#pragma GCC unroll 16
      for (int k = 0; k < columns; ++k) state[k] = load_first(pass.state[k] + p, n);
      StressResponse<F> response;
      LaneMask pushed;
      const P2GTerms<F> s = particle_step<M, F>(law, step, walls, g, u, state, response, pushed);

#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) store_first(u[a], pass.u[a] + p, n);
#pragma GCC unroll 16
      for (int k = 0; k < columns; ++k) store_first(state[k], pass.state[k] + p, n);
      if (pass.own_velocity[0])
        for (int a = 0; a < 3; ++a) store_first(s.own_velocity[a], pass.own_velocity[a] + p, n);
      const F j = volume_ratio(law, state);
      found.template add<M>(step, walls, n, g, s, j, response, u, pushed);
      if (pass.velocity)
        write_output(pass, p, n, s.own_velocity, affine_velocity(g.affine_moment, step.dx), response.energy, j);
      const F viscosity = response.kinematic_viscosity + response.implicit_viscosity;
      buffer.fill(pass, at, u, s, g.affine_moment, viscosity, j);
      *group = lane_group_of(u);
      if constexpr (rows_side_by_side)
#pragma GCC unroll 2
        for (int a = 0; a < 2; ++a) wide[a] += group->wide[a] & !group->wide[1 - a];
      ++group;
      if (pass.stress_out) {
        Vec3<F> slope[3];
        stress_slopes(step, response.tau, step.dt_next, slope);
        buffer.put_stress(at, u, slope, buffer.stress);
      }
    }
    // A position that is not finite has no nodes to go to.
    if (!found.finite()) break;
    fetch<columns>(pass, first + 2 * chunk);
    rows.fetch();
    buffer.flush(pass, particles);
  }
  found.add_to(pass, stats, there);
  for (int a = 0; a < 2; ++a) there.wide[a] += wide[a];
}

template <class M>
void run(const BlockPass& pass, PassStats& stats, BlockExtent& there) {
  const bool plain = is_plain(pass);
  if constexpr (VolumeRelaxed<M>)
    if (pass.step.volume_relaxation > 0)
      return plain ? run_step<M, true, true>(pass, stats, there) : run_step<M, true, false>(pass, stats, there);
  plain ? run_step<M, false, true>(pass, stats, there) : run_step<M, false, false>(pass, stats, there);
}

template <class M>
void run_viscous(const BlockPass& of) {
  constexpr int columns = state_columns<M>;
  const BlockPass pass = of;
  const SetStep<float> step = pass.step;
  const auto law = *static_cast<const typename M::template Law<float>*>(pass.law);
  const Source source(pass);
  ScatterBuffer buffer;
  const LaneGroup* group = pass.lane_groups;
  for (std::size_t first = pass.begin; first < pass.end; first += chunk) {
    fetch<columns>(pass, first + chunk);
    const int particles = chunk_size(pass, first);
    for (int at = 0; at < particles; at += W) {
      const int n = particles - at < W ? particles - at : W;
      const std::size_t p = first + static_cast<std::size_t>(at);
      Vec3<F> u, slope[3];
      for (int a = 0; a < 3; ++a) u[a] = load_first(pass.u[a] + p, n);
      Uninitialized<G2PResult<F>> room;
      source.template gather_apart<wants_of<M, false>>(u, *group++, room.value);
      typename M::template State<F> state;
#pragma GCC unroll 16
      for (int k = 0; k < columns; ++k) state[k] = load_first(pass.state[k] + p, n);
      viscous_slopes<M, F>(law, step, state, room.value.affine_moment, slope);
      buffer.put_stress(at, u, slope, buffer.terms);
    }
    buffer.flush(pass, particles);
  }
}

float fastest_of(const BlockPass& of) {
  const BlockPass pass = of;
  const Source source(pass);
  const LaneGroup* group = pass.lane_groups;
  F fastest2(0.0f);
  for (std::size_t first = pass.begin; first < pass.end; first += chunk) {
    fetch<0>(pass, first + chunk);
    const int particles = chunk_size(pass, first);
    for (int at = 0; at < particles; at += W) {
      const int n = particles - at < W ? particles - at : W;
      Vec3<F> u;
      for (int a = 0; a < 3; ++a) u[a] = load_first(pass.u[a] + first + static_cast<std::size_t>(at), n);
      Uninitialized<G2PResult<F>> room;
      source.template gather_apart<Wants{}>(u, *group++, room.value);
      fastest2 = max(dot(room.value.v, room.value.v), fastest2);
    }
  }
  return largest_of(fastest2);
}

/// Fits splines to the first `wanted` numbers of a node.
template <int wanted>
void fit(const Node<float>* grid, const ArenaPlace& place, int block, const ArenaReach& reach, int beside,
         float* splines) {
  using At = BlockSplines;
  alignas(64) static constexpr Node<float> none[block_nodes]{};
  const Node<float>* of[4][2];
  const bool wants[2] = {reach.first, reach.last};
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < 2; ++k) {
      const std::int32_t b = wants[k] ? place.pencil[side][block + k] : BlockList::none;
      of[side][k] = b != BlockList::none ? grid + b * block_nodes : none;
    }
  const int across = 1 - beside;
  for (int i = reach.low[across]; i <= reach.high[across]; ++i)
    for (int j = reach.low[beside] / NodeRows::rows * NodeRows::rows; j <= reach.high[beside]; j += NodeRows::rows) {
      const float* half[NodeRows::rows][2];
      for (int row = 0; row < NodeRows::rows; ++row) {
        const int x = beside == 0 ? j + row : i, y = beside == 0 ? i : j + row;
        for (int k = 0; k < 2; ++k) half[row][k] = &of[place.pencil_of(x, y)][k][place.first_in_block(x, y)].x;
      }
      for (int part = 0; part < NodeRows::parts; ++part) {
        const NodeRows nodes(half, part);
#pragma GCC unroll 4
        for (int number = 0; number < wanted; ++number) {
          const LineSpline<F> line =
              line_spline<F>(nodes.number(number, 0), nodes.number(number, 1), nodes.number(number, 2));
          float* const to = splines + At::at(i, number, 0, j) + part * W;
          line.middle.store(to), line.slope.store(to + At::at(0, 0, 1, 0)), line.bend.store(to + At::at(0, 0, 2, 0));
        }
      }
    }
}

/// Adds the numbers in both places of neighboring nodes to `to`, and empties the places. `place`:
/// the first node's second.
template <class Vec>
DM_FN void add_nodes(Node<float>* place, Node<float>* to) {
  float* const second = &place->x;
  float* const first = &(place - 2)->x;
  (Vec::load(&to->x) + (Vec::load(first) + Vec::load(second))).store(&to->x);
  Vec().store(first), Vec().store(second);
}

void add(Node<float>* arena, const ArenaPlace& place, Node<float>* grid) {
  place.for_rows(place.first(), place.end(), [&](int row, int b, int first) DM_INLINED {
    const auto from = [&](int k) DM_INLINED {
      return arena + row * ArenaSums::row_nodes + ArenaSums::place_of(b * block_width + k);
    };
    // The two in the middle lie side by side.
    add_nodes<OneNode>(from(0), &grid[first]);
    for (int k = 1; k < 3; k += NodePair::nodes) add_nodes<NodePair>(from(k), &grid[first + k]);
    add_nodes<OneNode>(from(3), &grid[first + 3]);
  });
}

void measure_extent(const float* const (&u)[3], std::size_t count, LaneGroup* lane_groups, Extent& extent) {
  LaneExtent all;
  for (std::size_t at = 0; at < count; at += W) {
    const int n = count - at < W ? static_cast<int>(count - at) : W;
    Vec3<F> position;
    for (int a = 0; a < 3; ++a) position[a] = load_first(u[a] + at, n);
    all.add(position);
    *lane_groups++ = lane_group_of(position);
  }
  all.add_to(extent);
}

float multiply_adds(std::uint64_t rounds) {
  F chain[multiply_add_chains];
  for (int i = 0; i < multiply_add_chains; ++i) chain[i] = F(static_cast<float>(i));
  const F factor(0.999f), term(0.001f);
  for (std::uint64_t r = 0; r < rounds; ++r)
    for (F& c : chain) c = mul_add(c, factor, term);
  F sum;
  for (const F& c : chain) sum += c;
  alignas(64) float lanes[W];
  sum.store(lanes);
  return lanes[0];
}

/// Tests build the kernels of some materials alone, by name.
template <class M>
constexpr bool is_built() {
#ifdef DM_ONLY_MATERIALS
  return std::string_view(DM_ONLY_MATERIALS).find(M::info.name) != std::string_view::npos;
#else
  return true;
#endif
}

template <class M>
constexpr void fill_in(Kernel& kernel, ViscousKernel& viscous) {
  if constexpr (is_built<M>()) {
    kernel = &run<M>;
    if constexpr (Viscous<M>) viscous = &run_viscous<M>;
  }
}

template <class... M>
constexpr void fill(Kernel* kernels, ViscousKernel* viscous, MaterialList<M...>) {
  int i = 0;
  ((fill_in<M>(kernels[i], viscous[i]), ++i), ...);
}

struct Table {
  Kernel kernels[Materials::size];
  ViscousKernel viscous[Materials::size];
  constexpr Table() : kernels{}, viscous{} { fill(kernels, viscous, Materials{}); }
};
constexpr Table table;

}  // namespace

const KernelTable& kernel_table() {
  static constexpr KernelTable t{DM_ISA_NAME,   W,
                                 table.kernels, &fastest_of,
                                 table.viscous, {&fit<4>, &fit<3>, &fit<1>, &add, &measure_extent, rows_side_by_side},
                                 &node_loops,   &multiply_adds};
  return t;
}

}  // namespace dreampm::DM_ISA
