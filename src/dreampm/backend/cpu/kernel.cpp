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

struct Chunk {
  alignas(64) float gathered[14][W];   // v, along[0..2], mass, blocked
  alignas(64) float scattered[12][W];  // q, slope[0..2]
  alignas(64) float u[3][W], ratio[W], viscosity[W];
  alignas(64) float own[3][W], before[3][W];  // only where velocities are kept
};

DM_FN Stencil<float> stencil_of(const Chunk& c, int lane) {
  return make_stencil(Vec3f{c.u[0][lane], c.u[1][lane], c.u[2][lane]});
}

DM_FN int first_node(const Stencil<float>& s) { return arena_index(s.base[0], s.base[1], s.base[2]); }
constexpr int offset(int i, int j, int k) { return (i * arena_width + j) * arena_width + k; }

DM_FN void gather_one(const BlockPass& pass, Chunk& c, int lane, bool wants_density) {
  const Stencil<float> s = stencil_of(c, lane);
  const Node<float>* base = pass.in + first_node(s);
  const Moments<Quad> m =
      gather<float, Quad>(s, [&](int i, int j, int k) { return Quad::load(&base[offset(i, j, k)].x); });
  alignas(16) float value[4];
  m.value.store(value);
  for (int i = 0; i < 3; ++i) c.gathered[i][lane] = value[i];
  const float mass = value[3];
  float blocked = 0;
  for (int a = 0; a < 3; ++a) {
    m.along[a].store(value);
    for (int i = 0; i < 3; ++i) c.gathered[3 + 3 * a + i][lane] = value[i];
  }
  if (wants_density && pass.liquid_in) {
    const LiquidNode<float>* l = pass.liquid_in + first_node(s);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) blocked += s.w[0].w[i] * s.w[1].w[j] * s.w[2].w[k] * l[offset(i, j, k)].blocked;
  }
  c.gathered[12][lane] = mass;
  c.gathered[13][lane] = blocked;
}

// The grid's velocity before its forces.
DM_FN void gather_before(const BlockPass& pass, Chunk& c, int lane) {
  const Stencil<float> s = stencil_of(c, lane);
  const Node<float>* base = pass.before_in + first_node(s);
  float x = 0, y = 0, z = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const float w = s.w[0].w[i] * s.w[1].w[j] * s.w[2].w[k];
        const Node<float>& n = base[offset(i, j, k)];
        x += n.x * w, y += n.y * w, z += n.z * w;
      }
  c.before[0][lane] = x, c.before[1][lane] = y, c.before[2][lane] = z;
}

// A node of an arena as four lanes that can be added to.
struct Slot {
  float* p;
  DM_FN operator Quad() const { return Quad::load(p); }
  DM_FN Quad operator+(Quad b) const { return Quad::load(p) + b; }
  DM_FN Slot& operator=(Quad b) {
    b.store(p);
    return *this;
  }
};

// Momentum without the step's forces.
DM_FN void scatter_before(const BlockPass& pass, const Chunk& c, int lane) {
  const Stencil<float> s = stencil_of(c, lane);
  Node<float>* base = pass.before_out + first_node(s);
  const auto quad = [](const Vec3f& v) {
    alignas(16) const float q[4] = {v.x, v.y, v.z, 0};
    return Quad::load(q);
  };
  const auto slope_of = [&](int a) {
    return quad(momentum_slope(
        Vec3f{c.gathered[3 + 3 * a][lane], c.gathered[4 + 3 * a][lane], c.gathered[5 + 3 * a][lane]}, pass.step));
  };
  const Quad q = quad({c.scattered[0][lane], c.scattered[1][lane], c.scattered[2][lane]});
  const Quad slope[3] = {slope_of(0), slope_of(1), slope_of(2)};
  Slot slot{};
  scatter(s, q, slope, [&](int i, int j, int k) -> Slot& {
    slot.p = &base[offset(i, j, k)].x;
    return slot;
  });
}

DM_FN void scatter_one(const BlockPass& pass, const Chunk& c, int lane, float cells) {
  const Stencil<float> s = stencil_of(c, lane);
  Node<float>* base = pass.out + first_node(s);
  const auto column = [&](int first, float w) {
    alignas(16)
        const float q[4] = {c.scattered[first][lane], c.scattered[first + 1][lane], c.scattered[first + 2][lane], w};
    return Quad::load(q);
  };
  const Quad q = column(0, pass.step.mass);
  const Quad slope[3] = {column(3, 0), column(6, 0), column(9, 0)};
  Slot slot{};
  scatter(s, q, slope, [&](int i, int j, int k) -> Slot& {
    slot.p = &base[offset(i, j, k)].x;
    return slot;
  });
  if (pass.liquid_out) {
    LiquidNode<float>* l = pass.liquid_out + first_node(s);
    const float viscosity = pass.liquid ? pass.step.mass * c.viscosity[lane] : 0.0f;
    const float solid = pass.liquid ? 0.0f : cells * c.ratio[lane];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
          const float w = s.w[0].w[i] * s.w[1].w[j] * s.w[2].w[k];
          l[offset(i, j, k)].viscosity += w * viscosity;
          l[offset(i, j, k)].blocked += w * solid;
        }
  }
}

template <class M>
void run(const BlockPass& pass, KernelStats& stats) {
  constexpr int columns = state_columns<M>;
  const auto& law = *static_cast<const typename M::template Law<float>*>(pass.law);
  const float cells = pass.step.volume / (pass.step.dx * pass.step.dx * pass.step.dx);
  const double mass = static_cast<double>(pass.step.mass), volume = static_cast<double>(pass.step.volume);
  Chunk c;
  alignas(64) float state_in[columns][W], out[16][W];
  for (std::size_t first = pass.begin; first < pass.end; first += W) {
    const int n = static_cast<int>(pass.end - first < W ? pass.end - first : W);
    // Idle lanes repeat the last particle, so that they can neither trap nor change a maximum.
    for (int l = 0; l < W; ++l) {
      const std::size_t p = first + static_cast<std::size_t>(l < n ? l : n - 1);
      for (int a = 0; a < 3; ++a) c.u[a][l] = pass.u[a][p];
      for (int k = 0; k < columns; ++k) state_in[k][l] = pass.state[k][p];
    }
    for (int l = 0; l < n; ++l) gather_one(pass, c, l, M::wants_density);
    if (pass.own[0])
      for (int l = 0; l < W; ++l) {
        const int from = l < n ? l : n - 1;
        for (int a = 0; a < 3; ++a) c.own[a][l] = pass.own[a][first + static_cast<std::size_t>(from)];
        gather_before(pass, c, l);  // idle lanes stand where the last particle does
      }
    for (int l = n; l < W; ++l)
      for (auto& row : c.gathered) row[l] = row[n - 1];

    const auto vec = [&](int row) {
      return Vec3<F>{F::load(c.gathered[row]), F::load(c.gathered[row + 1]), F::load(c.gathered[row + 2])};
    };
    Gathered<F> g{vec(0), {vec(3), vec(6), vec(9)}, F::load(c.gathered[12]), F::load(c.gathered[13]), {}, {}};
    if (pass.own[0])
      for (int a = 0; a < 3; ++a) g.own[a] = F::load(c.own[a]), g.before[a] = F::load(c.before[a]);
    Vec3<F> u{F::load(c.u[0]), F::load(c.u[1]), F::load(c.u[2])};
    typename M::template State<F> state;
    for (int k = 0; k < columns; ++k) state[k] = F::load(state_in[k]);
    Response<F> response;
    LaneMask pushed;
    const Scattered<F> s = particle_step<M, F>(law, pass.step, pass.walls, g, u, state, response, pushed);

    for (int a = 0; a < 3; ++a) {
      u[a].store(c.u[a]);
      s.own[a].store(c.own[a]);
      s.q[a].store(c.scattered[a]);
      for (int i = 0; i < 3; ++i) s.slope[a][i].store(c.scattered[3 + 3 * a + i]);
    }
    for (int k = 0; k < columns; ++k) state[k].store(state_in[k]);
    state.volume_ratio().store(c.ratio);
    response.sound_speed.store(out[0]);
    response.kinematic_viscosity.store(c.viscosity);
    select(pushed, F(1.0f), F(0.0f)).store(out[2]);
    const F sum = u.x + u.y + u.z + state.volume_ratio() + response.sound_speed;
    (sum - sum).store(out[3]);  // 0 if finite, NaN if not
    kinetic_energy(g, s, pass.step).store(out[4]);
    response.energy.store(out[5]);
    response.lost.viscous.store(out[6]);
    response.lost.plastic.store(out[7]);
    response.lost.relaxed.store(out[8]);
    for (int l = 0; l < n; ++l) {
      const std::size_t p = first + static_cast<std::size_t>(l);
      for (int a = 0; a < 3; ++a) pass.u[a][p] = c.u[a][l];
      for (int k = 0; k < columns; ++k) pass.state[k][p] = state_in[k][l];
      if (pass.own[0])
        for (int a = 0; a < 3; ++a) pass.own[a][p] = c.own[a][l];
      stats.wave_speed = out[0][l] > stats.wave_speed ? out[0][l] : stats.wave_speed;
      stats.viscosity = c.viscosity[l] > stats.viscosity ? c.viscosity[l] : stats.viscosity;
      stats.j_min = c.ratio[l] < stats.j_min ? c.ratio[l] : stats.j_min;
      stats.j_max = c.ratio[l] > stats.j_max ? c.ratio[l] : stats.j_max;
      stats.pushed += out[2][l] > 0;
      stats.kinetic += static_cast<double>(out[4][l]) * mass;
      stats.elastic += static_cast<double>(out[5][l]) * volume;
      stats.viscous += static_cast<double>(out[6][l]) * volume;
      stats.plastic += static_cast<double>(out[7][l]) * volume;
      stats.relaxed += static_cast<double>(out[8][l]) * volume;
      stats.finite = stats.finite && out[3][l] == 0;
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
    if (!stats.finite) return;
    for (int l = 0; l < n; ++l) scatter_one(pass, c, l, cells);
    if (pass.before_out)
      for (int l = 0; l < n; ++l) scatter_before(pass, c, l);
  }
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
  static constexpr KernelTable t{DM_ISA_NAME, W, table.kernels};
  return t;
}

}  // namespace dreampm::DM_ISA
