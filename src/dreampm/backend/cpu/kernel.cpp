// One pass over the particles of a block. This file is built once per instruction set (DM_ISA) with its own flags; it
// must export nothing but its table (tools/check_kernels).
// Particles go through it a chunk at a time: their vectors gather from the grid with one particle a lane, since those
// that lie in one row along z pick from the same nodes; then they give back one particle after the other, four nodes a
// vector.
#include "dreampm/backend/cpu/kernel.h"

#include <bit>
#include <memory>

#include "dreampm/math/lanes.h"
#include "dreampm/physics/materials.h"

static_assert(HWY_STATIC_TARGET == DM_HWY_TARGET,
              "Highway fell to another target than this file's flags are meant for");

namespace dreampm::DM_ISA {
namespace {

/// For lambdas, which know no DM_FN.
#define DM_INLINED __attribute__((always_inline))

using F = Lanes<float>;
using F2 = Twice<F>;
constexpr int W = F::count;

constexpr int offset(int i, int j, int k) { return (i * arena_width + j) * arena_width + k; }

/// Where the lanes' stencils lie in the arena: its coordinates of their first nodes.
struct Place {
  Stencil<F> stencil;
  F first[3];

  Place() = default;
  explicit DM_FN Place(const Vec3<F>& u) : stencil(make_stencil(u)) {
    for (int a = 0; a < 3; ++a) first[a] = stencil.base[a] + F(1.0f);
  }
};

/// An arena as rows of numbers along z, one row for each component of a node, so that lanes can pick from them.
template <int components>
struct Rows {
  static constexpr int row_floats = components * arena_width;
  alignas(64) float v[arena_width * row_floats * arena_width + RowPick::floats_read];

  DM_FN void lay(const Node<float>* nodes)
    requires(components == 4)
  {
    for (int r = 0; r < arena_width * arena_width; ++r)
      split_records<arena_width>(&nodes[r * arena_width].x, v + r * row_floats);
  }
};

/// Lanes that gather together: their stencils begin in two rows of the arena by two.
struct Team {
  Shared<F> x, y;
  LaneMask here;
  int row;  ///< the first of all

  Team() = default;
  /// As many of the lanes `left` as can be with the first of them.
  DM_FN Team(const Place& at, LaneMask left) {
    const float from[2] = {start(at.first[0], left), start(at.first[1], left)};
    row = static_cast<int>(from[0]) * arena_width + static_cast<int>(from[1]);
    const F half(0.5f), zero, one(1.0f), dx = at.first[0] - F(from[0]), dy = at.first[1] - F(from[1]);
    here = left && dx >= zero && dx <= one && dy >= zero && dy <= one;
    const LaneMask second_x = dx > half, second_y = dy > half;
    std::construct_at(&x, at.stencil.w[0], at.stencil.t[0], second_x);
    std::construct_at(&y, at.stencil.w[1], at.stencil.t[1], second_y);
    x.count = any(here && second_x) ? 4 : 3;
    y.count = any(here && second_y) ? 4 : 3;
  }

 private:
  static DM_FN float start(const F& first, LaneMask left) {
    alignas(64) float v[W];
    first.store(v);
    const float here = v[first_lane(left)];
    return any(left && first == F(here - 1.0f)) ? here - 1.0f : here;
  }
};

/// The arenas of one pass that its particles gather from.
class Source {
 public:
  DM_FN Source(const BlockPass& pass, bool blocked) : keeps_(pass.own[0] != nullptr), blocked_(blocked) {
    field_.lay(pass.in);
    if (keeps_) before_.lay(pass.before_in);
    if (blocked_)
      for (int n = 0; n < arena_nodes; ++n) blocked_rows_.v[n] = pass.liquid_in[n].blocked;
  }

  /// All but `own`. `first`: of all lanes; those that it leaves follow in others.
  template <bool wants_mass>
  DM_FN void gather_at(const Place& at, const Team& first, Gathered<F>& g) const {
    const RowPick pick[3] = {RowPick(at.first[2]), RowPick(at.first[2] + F(1.0f)), RowPick(at.first[2] + F(2.0f))};
    gather_team<wants_mass>(at, first, pick, g);
    LaneMask left = !first.here;
    while (any(left)) {
      const Team team(at, left);
      gather_team<wants_mass>(at, team, pick, g);
      left = left && !team.here;
    }
  }

 private:
  template <bool wants_mass>
  DM_FN void gather_team(const Place& at, const Team& team, const RowPick (&pick)[3], Gathered<F>& g) const {
    const F(&z)[3] = at.stencil.w[2];
    const auto take = [&](F& to, F found) DM_INLINED { to = select(team.here, found, to); };
    for (int c = 0; c < 3; ++c) {
      const Moments<F> m = gather<F>(team.x, team.y, z, at.stencil.t[2], rows_of(field_, team, c, pick));
      take(g.v[c], m.value);
      for (int a = 0; a < 3; ++a) take(g.along[a][c], m.along[a]);
    }
    if constexpr (wants_mass) take(g.mass, gather_value<F>(team.x, team.y, z, rows_of(field_, team, 3, pick)));
    if (blocked_) take(g.blocked, gather_value<F>(team.x, team.y, z, rows_of(blocked_rows_, team, 0, pick)));
    if (keeps_)
      for (int c = 0; c < 3; ++c)
        take(g.before[c], gather_value<F>(team.x, team.y, z, rows_of(before_, team, c, pick)));
  }
  /// For gather(): the rows of component `c`.
  template <int components>
  static DM_FN auto rows_of(const Rows<components>& rows, const Team& team, int c, const RowPick (&pick)[3]) {
    const float* const first = rows.v + team.row * Rows<components>::row_floats + c * arena_width;
    return [&pick, first](int i, int j) DM_INLINED {
      const float* at = first + (i * arena_width + j) * Rows<components>::row_floats;
      return NodeRow<F>{{pick[0].of(at), pick[1].of(at), pick[2].of(at)}};
    };
  }

  bool keeps_, blocked_;
  Rows<4> field_, before_;
  Rows<1> blocked_rows_;
};

/// Particles whose gifts to the grid are collected before they are handed out: runs of particles that share nodes get
/// longer, and what is collected still fits the nearest cache.
constexpr int chunk = 64;
/// One bit for each number of a chunk that equals `value`.
DM_FN std::uint64_t equal_to(const std::int32_t (&numbers)[chunk], std::int32_t value) {
  std::uint64_t bits = 0;
  for (int p = 0; p < chunk; p += W) bits |= lanes_equal(numbers + p, value) << p;
  return bits;
}

/// One record of four floats for each particle of a chunk, by record_of.
struct Records {
  alignas(64) float v[chunk * 4];
  DM_FN void put(int first, const F& a, const F& b, const F& c, const F& d) {
    store_records(a, b, c, d, v + 4 * first);
  }
};

struct RecordPlaces {
  std::int32_t at[chunk];
  constexpr RecordPlaces() : at{} {
    for (int p = 0; p < chunk; ++p) at[p] = 4 * (p / W * W + record_of(p % W));
  }
};
constexpr RecordPlaces record_places;

/// What a chunk's particles give to one field: momentum and mass at the second of the four nodes below, and what they
/// gain from node to node along each axis.
struct Gifts {
  Records middle, slope[3];

  /// `t`: of the particles from that node.
  DM_FN void put(int first, const Vec3<F>& q, const F& mass, const Vec3<F> (&slopes)[3], const F (&t)[3]) {
    F q_at[3];
    for (int c = 0; c < 3; ++c) {
      const F along[3] = {slopes[0][c], slopes[1][c], slopes[2][c]};
      q_at[c] = at_middle(q[c], along, t);
    }
    middle.put(first, q_at[0], q_at[1], q_at[2], mass);
    for (int a = 0; a < 3; ++a) slope[a].put(first, slopes[a].x, slopes[a].y, slopes[a].z, F());
  }
};

/// The stencils of a chunk, each within three by three rows of four nodes along z, which the particles of two cells
/// share. At the ends of an arena's rows one of the four lies in the next row, at a weight of zero.
class Outline {
 public:
  /// The stencils of the chunk's particles from number `first` on, as many as there are lanes. Gives the particles'
  /// distances from the second node of the four along z, and from the middle one along x and y: what Gifts::put wants.
  DM_FN void put(int first, const Place& at, F (&t)[3]) {
    const Stencil<F>& s = at.stencil;
    const F half(0.5f), pair = round_int((at.first[2] - F(1.0f)) * half - F(0.25f)), from = pair + pair + F(1.0f);
    const Shared<F> z(s.w[2], s.t[2], at.first[2] - from > half);
    t[0] = s.t[0], t[1] = s.t[1], t[2] = z.t;
    z_.put(first, z.w[0], z.w[1], z.w[2], z.w[3]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) (s.w[0][i] * s.w[1][j]).store(xy_[3 * i + j] + first);
    const F width(static_cast<float>(arena_width));
    store_whole(mul_add(mul_add(at.first[0], width, at.first[1]), width, from), first_ + first);
  }

  /// Adds gifts to the arena. Those of particles that share nodes are summed in registers, in their order.
  template <bool sloped>
  DM_FN void hand_out(int particles, const Gifts& gifts, Node<float>* out) const {
    alignas(64) static constexpr float nodes_from_second[16] = {-1, -1, -1, -1, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2};
    for (std::uint64_t left = ~std::uint64_t{0} >> (64 - particles); left != 0;) {
      const std::int32_t first = first_[std::countr_zero(left)];
      const std::uint64_t group = left & equal_to(first_, first);
      left &= ~group;
      for (int part = 0; part < 4; part += NodeVec::nodes) {
        const NodeVec steps = NodeVec::load(nodes_from_second + 4 * part);
        NodeVec sum[3][3];
        for (std::uint64_t rest = group; rest != 0; rest &= rest - 1) {
          const int p = std::countr_zero(rest), r = record_places.at[p];
          const NodeVec w = NodeVec::each(z_.v + r, part), q = NodeVec::repeat(gifts.middle.v + r);
          const auto add = [&](int i, int j, const NodeVec& row)
                               DM_INLINED { sum[i][j] = mul_add(row, xy_[3 * i + j][p], sum[i][j]); };
          if constexpr (sloped) {
            const auto slope = [&](int a) DM_INLINED { return NodeVec::repeat(gifts.slope[a].v + r); };
            spread_rows(w * mul_add(slope(2), steps, q), w * slope(0), w * slope(1), add);
          } else {
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j) add(i, j, w * q);
          }
        }
        float* base = &out[first + part].x;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            float* at = base + 4 * offset(i, j, 0);
            (NodeVec::load(at) + sum[i][j]).store(at);
          }
      }
    }
  }

 private:
  Records z_;  ///< weights of the four nodes
  alignas(64) float xy_[9][chunk];
  std::int32_t first_[chunk];  ///< arena index
};

/// KernelStats lane by lane. Sums of one block's few hundred particles lose nothing that a ledger would see.
class LaneStats {
 public:
  /// `n`: lanes that are in use; the others repeat one of them.
  template <class M>
  DM_FN void add(const SetStep<float>& step, int n, const Gathered<F2>& g, const Scattered<F2>& s,
                 const typename M::template State<F2>& state, const Response<F2>& response, const Vec3<F2>& u,
                 F2::Mask pushed) {
    alignas(64) static constexpr float numbers[32] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15,
                                                      16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31};
    const F2 zero(0.0f), j = state.volume_ratio(), lane{F::load(numbers), F::load(numbers + W)};
    const F2::Mask used = lane < F2(static_cast<float>(n));
    wave_speed_ = max(response.sound_speed, wave_speed_);
    viscosity_ = max(response.kinematic_viscosity, viscosity_);
    j_min_ = min(j, j_min_);
    j_max_ = max(j, j_max_);
    pushed_ += select(pushed && used, F2(1.0f), zero);
    const F2 energy[5] = {kinetic_energy(g, s, step), response.energy, response.lost.viscous, response.lost.plastic,
                          response.lost.relaxed};
    for (int i = 0; i < 5; ++i) energy_[i] += select(used, energy[i], zero);
    const F2 all = u.x + u.y + u.z + j + response.sound_speed, none = all - all;  // 0 if finite, NaN if not
    finite_ = finite_ && !any(!(none <= zero && none >= zero));
  }
  DM_FN bool finite() const { return finite_; }

  DM_FN void add_to(const BlockPass& pass, KernelStats& stats) const {
    alignas(64) float v[10][2 * W];
    const auto store = [](const F2& x, float* to) DM_INLINED { x.a.store(to), x.b.store(to + W); };
    store(wave_speed_, v[0]), store(viscosity_, v[1]), store(j_min_, v[2]), store(j_max_, v[3]), store(pushed_, v[4]);
    for (int i = 0; i < 5; ++i) store(energy_[i], v[5 + i]);
    const double mass = static_cast<double>(pass.step.mass), volume = static_cast<double>(pass.step.volume);
    for (int l = 0; l < 2 * W; ++l) {
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
  F2 wave_speed_, viscosity_, j_min_{1e30f}, j_max_{-1e30f}, pushed_, energy_[5];
  bool finite_ = true;
};

DM_FN F2 load_pair(const float* p, int n) {
  const F a = load_first(p, n < W ? n : W);
  return {a, n > W ? load_first(p + W, n - W) : a};
}
DM_FN void store_pair(const F2& x, float* p, int n) {
  store_first(x.a, p, n < W ? n : W);
  if (n > W) store_first(x.b, p + W, n - W);
}
/// Lane by lane, two vectors as one.
DM_FN Vec3<F2> join(const Vec3<F>& a, const Vec3<F>& b) { return {{a.x, b.x}, {a.y, b.y}, {a.z, b.z}}; }
DM_FN Gathered<F2> join(const Gathered<F>& a, const Gathered<F>& b) {
  Gathered<F2> g{join(a.v, b.v), {}, {a.mass, b.mass}, {a.blocked, b.blocked}, {}, join(a.before, b.before)};
  for (int i = 0; i < 3; ++i) g.along[i] = join(a.along[i], b.along[i]);
  return g;
}

/// What a chunk's particles give to the fields of the grid.
struct Given {
  Outline outline;
  Gifts gifts, before, liquid;

  /// Of the particles from `first` on, which lie at `u` now.
  DM_FN void put(const BlockPass& pass, int first, const Vec3<F>& u, const Scattered<F>& s, const Vec3<F> (&along)[3],
                 const F& viscosity, const F& volume_ratio) {
    F t[3];
    outline.put(first, Place(u), t);
    gifts.put(first, s.q, F(pass.step.mass), s.slope, t);
    if (pass.before_out) {
      Vec3<F> slope[3];
      for (int a = 0; a < 3; ++a) slope[a] = momentum_slope(along[a], pass.step);
      before.put(first, s.q, F(), slope, t);
    }
    if (!pass.liquid_out) return;
    const float cells = pass.step.volume / (pass.step.dx * pass.step.dx * pass.step.dx);
    if (pass.liquid)
      liquid.middle.put(first, F(), viscosity * F(pass.step.mass), F(), F());
    else
      liquid.middle.put(first, volume_ratio * F(cells), F(), F(), F());
  }
  DM_FN void hand_out(const BlockPass& pass, int particles) const {
    outline.template hand_out<true>(particles, gifts, pass.out);
    if (pass.before_out) outline.template hand_out<true>(particles, before, pass.before_out);
    if (pass.liquid_out) outline.template hand_out<false>(particles, liquid, pass.liquid_out);
  }
};

/// What a frame or a probe wants to know of the particles from `p` on.
DM_FN void tell(const BlockPass& pass, std::size_t p, int n, const Vec3<F2>& v, const Mat3<F2>& gradient,
                const F2& energy, const F2& volume_ratio) {
  alignas(64) float out[12][2 * W];
  const auto store = [](const F2& x, float* to) DM_INLINED { x.a.store(to), x.b.store(to + W); };
  for (int a = 0; a < 3; ++a) store(v[a], out[a]);
  for (int k = 0; k < 9; ++k) store(gradient.m[k], out[3 + k]);
  store_pair(energy, pass.energy + p, n);
  store_pair(volume_ratio, pass.volume_ratio + p, n);
  for (int l = 0; l < n; ++l) {
    const std::size_t to = p + static_cast<std::size_t>(l);
    for (std::size_t a = 0; a < 3; ++a) pass.velocity[3 * to + a] = out[a][l];
    for (std::size_t k = 0; k < 9; ++k) pass.gradient[9 * to + k] = out[3 + k][l];
  }
}

template <class M>
void run(const BlockPass& of, KernelStats& stats) {
  constexpr int columns = state_columns<M>;
  // Copies that no store can reach: else all that follows from them alone would be worked out for every vector anew.
  const BlockPass pass = of;
  const SetStep<float> step = pass.step;
  const BlockWalls<float> walls = pass.walls;
  const auto law = *static_cast<const typename M::template Law<float>*>(pass.law);
  const Source source(pass, M::info.liquid && pass.liquid_in);
  Given given;
  LaneStats found;
  Place places[chunk / W];
  Team teams[chunk / W];
  Gathered<F> gathered[chunk / W];
  for (std::size_t first = pass.begin; first < pass.end; first += chunk) {
    const int particles = static_cast<int>(pass.end - first < chunk ? pass.end - first : chunk);
    const auto load = [&](const float* column, int at) DM_INLINED {
      return load_pair(column + first + at, particles - at < 2 * W ? particles - at : 2 * W);
    };
    // One after the other, so that vectors need not wait for where the one before them gathers.
    for (int at = 0; at < particles; at += W) {
      const int n = particles - at < W ? particles - at : W;
      Vec3<F> u;
      for (int a = 0; a < 3; ++a) u[a] = load_first(pass.u[a] + first + at, n);
      std::construct_at(&places[at / W], u);
      std::construct_at(&teams[at / W], places[at / W], all_lanes());
    }
    for (int v = 0; v * W < particles; ++v)
      source.template gather_at<M::wants_density>(places[v], teams[v], gathered[v]);
    for (int at = 0; at < particles; at += 2 * W) {
      const int n = particles - at < 2 * W ? particles - at : 2 * W;
      const std::size_t p = first + static_cast<std::size_t>(at);
      const Gathered<F>* const each = &gathered[at / W];
      Gathered<F2> g = join(each[0], each[n > W ? 1 : 0]);
      Vec3<F2> u;
      for (int a = 0; a < 3; ++a) u[a] = load(pass.u[a], at);
      if (pass.own[0])
        for (int a = 0; a < 3; ++a) g.own[a] = load(pass.own[a], at);
      typename M::template State<F2> state;
      for (int k = 0; k < columns; ++k) state[k] = load(pass.state[k], at);
      Response<F2> response;
      F2::Mask pushed;
      const Scattered<F2> s = particle_step<M, F2>(law, step, walls, g, u, state, response, pushed);

      for (int a = 0; a < 3; ++a) store_pair(u[a], pass.u[a] + p, n);
      for (int k = 0; k < columns; ++k) store_pair(state[k], pass.state[k] + p, n);
      if (pass.own[0])
        for (int a = 0; a < 3; ++a) store_pair(s.own[a], pass.own[a] + p, n);
      found.add<M>(step, n, g, s, state, response, u, pushed);
      if (pass.velocity)
        tell(pass, p, n, s.own, affine_velocity(g.along, F2(step.dx)), response.energy, state.volume_ratio());
      // A position that is not finite has no nodes to go to.
      if (!found.finite()) {
        found.add_to(pass, stats);
        return;
      }
      const F2 viscosity = response.kinematic_viscosity + response.implicit_viscosity, j = state.volume_ratio();
      const auto give = [&](auto half, int to) DM_INLINED {
        const auto vec = [&](const Vec3<F2>& v) DM_INLINED { return Vec3<F>{half(v.x), half(v.y), half(v.z)}; };
        const Scattered<F> mine{vec(s.q), {vec(s.slope[0]), vec(s.slope[1]), vec(s.slope[2])}, vec(s.own)};
        const Vec3<F> along[3] = {vec(g.along[0]), vec(g.along[1]), vec(g.along[2])};
        given.put(pass, to, vec(u), mine, along, half(viscosity), half(j));
      };
      give([](const F2& x) DM_INLINED { return x.a; }, at);
      if (n > W) give([](const F2& x) DM_INLINED { return x.b; }, at + W);
    }
    given.hand_out(pass, particles);
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
