// One pass over the particles of a block. This file is built once per instruction set (DM_ISA) with its own flags; it
// must export nothing but its table (tools/check_kernels).
#include "dreampm/backend/cpu/kernel.h"

#include "dreampm/math/lanes.h"
#include "dreampm/physics/materials.h"

static_assert(HWY_STATIC_TARGET == DM_HWY_TARGET,
              "Highway fell to another target than this file's flags are meant for");

namespace dreampm::DM_ISA {
namespace {

using F = Lanes<float>;
constexpr int W = F::count;

/// The particles of one pass through the lanes. Records have four floats, so that one load turns them into lanes.
struct Chunk {
  struct AxisRecords {
    float w[W][4], moment[W][4];  // three of each; the fourth of `moment` is the first node of the axis
  };
  alignas(64) AxisRecords axis[3];
  using NodeRecords = float[4][W][4];
  alignas(64) NodeRecords node;    // gathered: v and mass, along[0..2]; scattered: q and mass, slope[0..2]
  alignas(64) NodeRecords before;  // scattered where a set of the field keeps velocities: the same without forces
  alignas(64) float u[3][W], blocked[W], ratio[W], viscosity[W];
  alignas(64) float own[3][W], grid_before[3][W];  // only where the set keeps velocities
};

/// One axis of one particle's stencil, as the transfer wants it.
struct AxisView {
  const float *w, *moment;
};
DM_FN AxisView axis_of(const Chunk& c, int a, int lane) { return {c.axis[a].w[lane], c.axis[a].moment[lane]}; }

DM_FN void lay_stencils(Chunk& c, const Vec3<F>& u) {
  const Stencil<F> s = make_stencil(u);
  for (int a = 0; a < 3; ++a) {
    const Axis<F>& axis = s.axis[a];
    store_records(axis.w[0], axis.w[1], axis.w[2], axis.first, c.axis[a].w[0]);
    store_records(axis.moment[0], axis.moment[1], axis.moment[2], s.base[a], c.axis[a].moment[0]);
  }
}
DM_FN int first_node(const Chunk& c, int lane) {
  return arena_index(static_cast<int>(c.axis[0].moment[lane][3]), static_cast<int>(c.axis[1].moment[lane][3]),
                     static_cast<int>(c.axis[2].moment[lane][3]));
}
constexpr int offset(int i, int j, int k) { return (i * arena_width + j) * arena_width + k; }

/// Calls body(node, weight) for the 27 nodes of a stencil.
template <class Body>
DM_FN void for_stencil(const Chunk& c, int lane, const Body& body) {
  const int first = first_node(c, lane);
  const float *x = c.axis[0].w[lane], *y = c.axis[1].w[lane], *z = c.axis[2].w[lane];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) body(first + offset(i, j, k), x[i] * y[j] * z[k]);
}

DM_FN void gather_one(const BlockPass& pass, Chunk& c, int lane) {
  const float* base = &pass.in[first_node(c, lane)].x;
  const Moments<Quad> m = gather<QuadRow>(axis_of(c, 0, lane), axis_of(c, 1, lane), axis_of(c, 2, lane),
                                          [&](int i, int j) { return QuadRow::load(base + 4 * offset(i, j, 0)); });
  m.value.store(c.node[0][lane]);
  for (int a = 0; a < 3; ++a) m.along[a].store(c.node[1 + a][lane]);
}

/// The grid's velocity before its forces.
DM_FN void gather_before(const BlockPass& pass, Chunk& c, int lane) {
  float v[3] = {0, 0, 0};
  for_stencil(c, lane, [&](int node, float w) {
    const Node<float>& n = pass.before_in[node];
    v[0] += n.x * w, v[1] += n.y * w, v[2] += n.z * w;
  });
  for (int a = 0; a < 3; ++a) c.grid_before[a][lane] = v[a];
}

/// Sums of the particles that share a cell: neighbours in the list mostly do, and a sum that stays in place costs no
/// overlapping stores to the arena.
class CellSum {
 public:
  explicit DM_FN CellSum(Node<float>* out) : out_(out) {}
  DM_FN ~CellSum() { flush(); }
  CellSum(const CellSum&) = delete;
  CellSum& operator=(const CellSum&) = delete;

  DM_FN void add(const Chunk& c, const Chunk::NodeRecords& node, int lane) {
    const int first = first_node(c, lane);
    if (first != first_) {
      flush();
      first_ = first;
      for (auto& row : rows_) QuadRow().store(row);
    }
    const float* const slope[3] = {node[1][lane], node[2][lane], node[3][lane]};
    const float* const q = node[0][lane];
    scatter<QuadRow>(axis_of(c, 0, lane), axis_of(c, 1, lane), axis_of(c, 2, lane), q, slope,
                     [&](int i, int j, const QuadRow& row) {
                       float* sum = rows_[3 * i + j];
                       (QuadRow::load(sum) + row).store(sum);
                     });
  }

 private:
  DM_FN void flush() {
    if (first_ < 0) return;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        float* out = &out_[first_ + offset(i, j, 0)].x;
        (QuadRow::load(out) + QuadRow::load(rows_[3 * i + j])).store(out);
      }
  }

  Node<float>* out_;
  int first_ = -1;
  alignas(64) float rows_[9][16];
};

DM_FN void scatter_liquid(const BlockPass& pass, const Chunk& c, int lane, float cells) {
  const float viscosity = pass.liquid ? pass.step.mass * c.viscosity[lane] : 0.0f;
  const float solid = pass.liquid ? 0.0f : cells * c.ratio[lane];
  for_stencil(c, lane, [&](int node, float w) {
    pass.liquid_out[node].viscosity += w * viscosity;
    pass.liquid_out[node].blocked += w * solid;
  });
}

/// KernelStats lane by lane. Sums of one block's few hundred particles lose nothing that a ledger would see.
class LaneStats {
 public:
  /// `n`: lanes that are in use; the others repeat one of them.
  template <class M>
  DM_FN void add(const BlockPass& pass, int n, const Gathered<F>& g, const Scattered<F>& s,
                 const typename M::template State<F>& state, const Response<F>& response, const Vec3<F>& u,
                 LaneMask pushed) {
    alignas(64) static constexpr float lane_numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const F zero(0.0f), j = state.volume_ratio();
    const LaneMask used = F::load(lane_numbers) < F(static_cast<float>(n));
    wave_speed_ = max(response.sound_speed, wave_speed_);
    viscosity_ = max(response.kinematic_viscosity, viscosity_);
    j_min_ = min(j, j_min_);
    j_max_ = max(j, j_max_);
    pushed_ += select(pushed && used, F(1.0f), zero);
    const F energy[5] = {kinetic_energy(g, s, pass.step), response.energy, response.lost.viscous, response.lost.plastic,
                         response.lost.relaxed};
    for (int i = 0; i < 5; ++i) energy_[i] += select(used, energy[i], zero);
    const F all = u.x + u.y + u.z + j + response.sound_speed, none = all - all;  // 0 if finite, NaN if not
    finite_ = finite_ && !any(!(none <= zero && none >= zero));
  }
  DM_FN bool finite() const { return finite_; }

  DM_FN void add_to(const BlockPass& pass, KernelStats& stats) const {
    alignas(64) float v[10][W];
    wave_speed_.store(v[0]), viscosity_.store(v[1]), j_min_.store(v[2]), j_max_.store(v[3]), pushed_.store(v[4]);
    for (int i = 0; i < 5; ++i) energy_[i].store(v[5 + i]);
    const double mass = static_cast<double>(pass.step.mass), volume = static_cast<double>(pass.step.volume);
    for (int l = 0; l < W; ++l) {
      stats.wave_speed = v[0][l] > stats.wave_speed ? v[0][l] : stats.wave_speed;
      stats.viscosity = v[1][l] > stats.viscosity ? v[1][l] : stats.viscosity;
      stats.j_min = v[2][l] < stats.j_min ? v[2][l] : stats.j_min;
      stats.j_max = v[3][l] > stats.j_max ? v[3][l] : stats.j_max;
      stats.pushed += static_cast<std::uint32_t>(v[4][l]);
      stats.kinetic += static_cast<double>(v[5][l]) * mass;
      stats.elastic += static_cast<double>(v[6][l]) * volume;
      stats.viscous += static_cast<double>(v[7][l]) * volume;
      stats.plastic += static_cast<double>(v[8][l]) * volume;
      stats.relaxed += static_cast<double>(v[9][l]) * volume;
    }
    stats.finite = stats.finite && finite_;
  }

 private:
  F wave_speed_, viscosity_, j_min_{1e30f}, j_max_{-1e30f}, pushed_, energy_[5];
  bool finite_ = true;
};

template <class M>
void run(const BlockPass& pass, KernelStats& stats) {
  constexpr int columns = state_columns<M>;
  const auto& law = *static_cast<const typename M::template Law<float>*>(pass.law);
  const float cells = pass.step.volume / (pass.step.dx * pass.step.dx * pass.step.dx);
  Chunk c;
  CellSum sum(pass.out), sum_before(pass.before_out);
  LaneStats found;
  alignas(64) float state_in[columns][W], out[10][W];
  for (std::size_t first = pass.begin; first < pass.end; first += W) {
    const int n = static_cast<int>(pass.end - first < W ? pass.end - first : W);
    // Idle lanes repeat the last particle, so that they can neither trap nor change a maximum.
    for (int l = 0; l < W; ++l) {
      const std::size_t p = first + static_cast<std::size_t>(l < n ? l : n - 1);
      for (int a = 0; a < 3; ++a) c.u[a][l] = pass.u[a][p];
      for (int k = 0; k < columns; ++k) state_in[k][l] = pass.state[k][p];
    }
    Vec3<F> u{F::load(c.u[0]), F::load(c.u[1]), F::load(c.u[2])};
    lay_stencils(c, u);
    for (int l = 0; l < W; ++l) {
      gather_one(pass, c, l);
      c.blocked[l] = 0;
      if (M::info.liquid && pass.liquid_in)
        for_stencil(c, l, [&](int node, float w) { c.blocked[l] += w * pass.liquid_in[node].blocked; });
    }
    Gathered<F> g;
    if (pass.own[0]) {
      for (int l = 0; l < W; ++l) {
        for (int a = 0; a < 3; ++a) c.own[a][l] = pass.own[a][first + static_cast<std::size_t>(l < n ? l : n - 1)];
        gather_before(pass, c, l);
      }
      for (int a = 0; a < 3; ++a) g.own[a] = F::load(c.own[a]), g.before[a] = F::load(c.grid_before[a]);
    }
    F idle;
    load_records(c.node[0][0], g.v.x, g.v.y, g.v.z, g.mass);
    for (int a = 0; a < 3; ++a) load_records(c.node[1 + a][0], g.along[a].x, g.along[a].y, g.along[a].z, idle);
    g.blocked = F::load(c.blocked);
    typename M::template State<F> state;
    for (int k = 0; k < columns; ++k) state[k] = F::load(state_in[k]);
    Response<F> response;
    LaneMask pushed;
    const Scattered<F> s = particle_step<M, F>(law, pass.step, pass.walls, g, u, state, response, pushed);

    for (int a = 0; a < 3; ++a) u[a].store(c.u[a]), s.own[a].store(c.own[a]);
    for (int k = 0; k < columns; ++k) state[k].store(state_in[k]);
    state.volume_ratio().store(c.ratio);
    (response.kinematic_viscosity + response.implicit_viscosity).store(c.viscosity);
    found.add<M>(pass, n, g, s, state, response, u, pushed);
    for (int l = 0; l < n; ++l) {
      const std::size_t p = first + static_cast<std::size_t>(l);
      for (int a = 0; a < 3; ++a) pass.u[a][p] = c.u[a][l];
      for (int k = 0; k < columns; ++k) pass.state[k][p] = state_in[k][l];
      if (pass.own[0])
        for (int a = 0; a < 3; ++a) pass.own[a][p] = c.own[a][l];
    }
    if (pass.velocity) {
      const Mat3<F> gradient = affine_velocity(g.along, F(pass.step.dx));
      for (int k = 0; k < 9; ++k) gradient.m[k].store(out[k]);
      response.energy.store(out[9]);
      for (int l = 0; l < n; ++l) {
        const std::size_t p = first + static_cast<std::size_t>(l);
        for (int a = 0; a < 3; ++a) pass.velocity[3 * p + static_cast<std::size_t>(a)] = c.own[a][l];
        for (int k = 0; k < 9; ++k) pass.gradient[9 * p + static_cast<std::size_t>(k)] = out[k][l];
        pass.energy[p] = out[9][l];
        pass.volume_ratio[p] = c.ratio[l];
      }
    }
    // A position that is not finite has no nodes to go to.
    if (!found.finite()) break;
    lay_stencils(c, u);
    const F zero(0.0f);
    store_records(s.q.x, s.q.y, s.q.z, F(pass.step.mass), c.node[0][0]);
    for (int a = 0; a < 3; ++a) store_records(s.slope[a].x, s.slope[a].y, s.slope[a].z, zero, c.node[1 + a][0]);
    if (pass.before_out) {
      store_records(s.q.x, s.q.y, s.q.z, zero, c.before[0][0]);
      for (int a = 0; a < 3; ++a) {
        const Vec3<F> slope = momentum_slope(g.along[a], pass.step);
        store_records(slope.x, slope.y, slope.z, zero, c.before[1 + a][0]);
      }
    }
    for (int l = 0; l < n; ++l) {
      sum.add(c, c.node, l);
      if (pass.before_out) sum_before.add(c, c.before, l);
      if (pass.liquid_out) scatter_liquid(pass, c, l, cells);
    }
  }
  found.add_to(pass, stats);
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

template <class... M>
constexpr void fill(Kernel* table, MaterialList<M...>) {
  int i = 0;
  ((table[i++] = &run<M>), ...);
}

struct Table {
  Kernel kernels[Materials::size];
  constexpr Table() : kernels{} { fill(kernels, Materials{}); }
};
constexpr Table table;

}  // namespace

const KernelTable& kernel_table() {
  static constexpr KernelTable t{DM_ISA_NAME, W, table.kernels, &multiply_adds};
  return t;
}

}  // namespace dreampm::DM_ISA
