// The scatter of a chunk of particles into an arena: one particle after the other, four nodes a
// vector.
#pragma once
#include <bit>

#include "dreampm/backend/cpu/gather.h"

namespace dreampm::DM_ISA {
namespace {

constexpr int row_offset(int i, int j) { return (i * arena_width + j) * ArenaSums::row_nodes; }

/// Particles whose terms are buffered before they are added to the grid: runs of particles that
/// share nodes get longer, and the buffer still fits the nearest cache.
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
  DM_FN void fill(int first, const F& a, const F& b, const F& c, const F& d) {
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

/// The terms that a chunk's particles add to one field: momentum and mass at the second of the four
/// nodes below, and their slopes from node to node along each axis.
struct ScatterTerms {
  Records middle, slope[3];

  /// `t`: of the particles from that node.
  DM_FN void fill(int first, const Vec3<F>& q, const F& mass, const Vec3<F> (&slopes)[3], const F (&t)[3]) {
    F q_at[3];
    for (int c = 0; c < 3; ++c) {
      const F along[3] = {slopes[0][c], slopes[1][c], slopes[2][c]};
      q_at[c] = at_middle(q[c], along, t);
    }
    middle.fill(first, q_at[0], q_at[1], q_at[2], mass);
    for (int a = 0; a < 3; ++a) slope[a].fill(first, slopes[a].x, slopes[a].y, slopes[a].z, F());
  }
};

/// The stencils of a chunk, each within three by three rows of four nodes along z, which the
/// particles of two cells share. At the ends of an arena's rows one of the four lies beyond it, at
/// a weight of zero.
class StencilBatch {
 public:
  /// The stencils of the chunk's particles from number `first` on, as many as there are lanes,
  /// which lie at `u`. Gives the particles' distances from the second node of the four along z, and
  /// from the middle one along x and y: what ScatterTerms::put takes.
  DM_FN void fill(int first, const Vec3<F>& u, F (&t)[3]) {
    const Stencil<F> s = make_stencil(u);
    const F half(0.5f), pair = round_int(mul_sub(s.base[2], half, F(0.25f)));
    const Shared<F, 4> z(s.w[2], s.t[2], s.base[2] > mul_add(pair, F(2.0f), half));
    t[0] = s.t[0], t[1] = s.t[1], t[2] = z.t;
    z_.fill(first, z.w[0], z.w[1], z.w[2], z.w[3]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) (s.w[0][i] * s.w[1][j]).store(xy_[3 * i + j] + first);
    const auto number = [](int n) DM_INLINED { return F(static_cast<float>(n)); };
    const F in_row = mul_add(pair, F(4.0f), number(row_offset(1, 1) + 4));
    store_whole(mul_add(s.base[0], number(row_offset(1, 0)), mul_add(s.base[1], number(row_offset(0, 1)), in_row)),
                first_ + first);
  }

  /// Adds terms to the arena. Those of particles that share nodes are summed in registers, in their
  /// order. A function of its own, so that what a step keeps in registers does not push out the
  /// constants of this loop.
  template <bool sloped>
  __attribute__((noinline)) void flush(int particles, const ScatterTerms& terms, Node<float>* out) const {
    alignas(64) static constexpr float nodes_from_second[16] = {-1, -1, -1, -1, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2};
    std::uint64_t left = ~std::uint64_t{0} >> (64 - particles);
    // Each group is found before the one ahead of it is summed: where that ends no processor
    // foresees, and it would begin to look only then.
    for (Group group = group_in(left), next; group.members != 0; group = next) {
      left &= ~group.members;
      next = group_in(left);
      for (int part = 0; part < 4; part += NodeVec::nodes) {
        const NodeVec steps = NodeVec::load(nodes_from_second + 4 * part);
        float* const base = &out[group.first + part].x;
        NodeVec sum[3][3];
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) sum[i][j] = NodeVec::load(base + 4 * row_offset(i, j));
        for (std::uint64_t rest = group.members; rest != 0; rest &= rest - 1) {
          const int p = std::countr_zero(rest), r = record_places.at[p];
          const NodeVec w = NodeVec::each(z_.v + r, part), q = NodeVec::repeat(terms.middle.v + r);
          // In one register: a multiply-add from memory whose address takes two is split, and the
          // split costs more than the addition.
          const float* weights = &xy_[0][p];
          asm("" : "+r"(weights));
          const auto add = [&](int i, int j, const NodeVec& row)
                               DM_INLINED { sum[i][j] = mul_add(row, weights[(3 * i + j) * chunk], sum[i][j]); };
          if constexpr (sloped) {
            const auto slope = [&](int a) DM_INLINED { return NodeVec::repeat(terms.slope[a].v + r); };
            spread_rows(w * mul_add(slope(2), steps, q), w * slope(0), w * slope(1), add);
          } else {
            for (int i = 0; i < 3; ++i)
              for (int j = 0; j < 3; ++j) add(i, j, w * q);
          }
        }
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) sum[i][j].store(base + 4 * row_offset(i, j));
      }
    }
  }

 private:
  /// Particles of a chunk that share their nodes, one bit each.
  struct Group {
    std::int32_t first;
    std::uint64_t members;
  };
  /// The first of `left` and those that share its nodes.
  DM_FN Group group_in(std::uint64_t left) const {
    const std::int32_t first = first_[std::countr_zero(left) % chunk];
    return {first, left & equal_to(first_, first)};
  }

  Records z_;  ///< weights of the four nodes
  alignas(64) float xy_[9][chunk];
  std::int32_t first_[chunk];  ///< where in the arena their four nodes begin
};

/// The terms of a chunk's particles for all fields of the grid.
struct ScatterBuffer {
  StencilBatch stencils;
  ScatterTerms terms, before, mixture, stress;

  /// Scatters the particles from `first` on, which lie at `u` now.
  DM_FN void fill(const BlockPass& pass, int first, const Vec3<F>& u, const P2GTerms<F>& s,
                  const Vec3<F> (&affine_moment)[3], const F& viscosity, const F& volume_ratio) {
    F t[3];
    stencils.fill(first, u, t);
    terms.fill(first, s.q, F(pass.step.mass), s.slope, t);
    if (pass.velocity_old_out) {
      const OldVelocityTerm<F> b(s, affine_moment, pass.step);
      before.fill(first, b.q, b.mass, b.slope, t);
    }
    if (!pass.mixture_out) return;
    const F cells(pass.step.volume / (pass.step.dx * pass.step.dx * pass.step.dx));
    mixture.middle.fill(first, pass.liquid ? F() : volume_ratio * cells, pass.own_field ? F() : cells,
                        pass.own_field ? cells : F(), pass.liquid ? viscosity * F(pass.step.mass) : F());
  }
  /// Stress alone, of particles at `u`.
  DM_FN void put_stress(int first, const Vec3<F>& u, const Vec3<F> (&slope)[3], ScatterTerms& to) {
    F t[3];
    stencils.fill(first, u, t);
    to.fill(first, {}, F(), slope, t);
  }
  DM_FN void flush(const BlockPass& pass, int particles) const {
    stencils.template flush<true>(particles, terms, pass.out);
    if (pass.velocity_old_out) stencils.template flush<true>(particles, before, pass.velocity_old_out);
    if (pass.stress_out) stencils.template flush<true>(particles, stress, pass.stress_out);
    if (pass.mixture_out) stencils.template flush<false>(particles, mixture, pass.mixture_out);
  }
};

}  // namespace
}  // namespace dreampm::DM_ISA
