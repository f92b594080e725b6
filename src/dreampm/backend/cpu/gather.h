// How a vector of particles gathers from an arena: one particle a lane, since particles that lie in one row along z
// pick from the same nodes.
#pragma once
#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/math/lanes.h"

/// For lambdas, which know no DM_FN.
#define DM_INLINED __attribute__((always_inline))

namespace dreampm::DM_ISA {
namespace {

using F = Lanes<float>;
constexpr int W = F::count;
static_assert(RowPick::floats_read <= ArenaRows<1>::room);

/// Whether the lanes of a vector can gather together: if their stencils begin in two rows of the arena by two.
struct Team {
  bool together;
  float x, y;           ///< the first of the rows
  bool wide_x, wide_y;  ///< whether some stencils begin at the second

  Team() = default;
  /// `ux`, `uy`: of particles, as in ParticleSet::u.
  DM_FN Team(const F& ux, const F& uy) {
    const F first_x = first_node(ux), first_y = first_node(uy), half(0.5f), two_rows(1.5f);
    x = smallest_of(first_x), y = smallest_of(first_y);
    const F dx = first_x - F(x), dy = first_y - F(y);
    together = !any(dx > two_rows || dy > two_rows);
    wide_x = any(dx > half);
    wide_y = any(dy > half);
  }

  /// As make_stencil() does, in the arena.
  static DM_FN F first_node(const F& u) { return round_int(u - F(0.5f)) + F(1.0f); }
};

constexpr int row_floats(int numbers, int i, int j) { return (i * arena_width + j) * numbers * arena_depth; }

// What follows gives gather() its rows: of<numbers>(rows of an arena, number).

#ifndef __AVX512F__
/// Lanes whose stencils begin in the same rows: all pick from the same.
class SharedRows {
 public:
  DM_FN SharedRows(const Stencil<F>& s, const Team& team)
      : pick_{RowPick(s.base[2] + F(1.0f)), RowPick(s.base[2] + F(2.0f)), RowPick(s.base[2] + F(3.0f))},
        x_(static_cast<int>(team.x)),
        y_(static_cast<int>(team.y)) {}
  template <int numbers>
  DM_FN auto of(const float* rows, int number) const {
    const float* const from = rows + row_floats(numbers, x_, y_) + number * arena_depth;
    return [this, from](int i, int j) DM_INLINED {
      const float* at = from + row_floats(numbers, i, j);
      return NodeRow<F>{{pick_[0].of(at), pick_[1].of(at), pick_[2].of(at)}};
    };
  }

 private:
  RowPick pick_[3];
  int x_, y_;
};
#else
/// Lanes whose stencils begin in two rows by two: each picks from the four rows that may be its own.
class SquareRows {
 public:
  DM_FN SquareRows(const Stencil<F>& s, const Team& team) : x_(first_row(team.x)), y_(first_row(team.y)) {
    const F zero(0.0f), row(8.0f), pair(16.0f), half(0.5f);
    const F index = s.base[2] + F(1.0f) + select(s.base[1] + half > F(static_cast<float>(y_)), row, zero) +
                    select(s.base[0] + half > F(static_cast<float>(x_)), pair, zero);
    for (int k = 0; k < 3; ++k) pick_[k] = SquarePick(index + F(static_cast<float>(k)));
  }
  template <int numbers>
  DM_FN auto of(const float* rows, int number) const {
    const float* const from = rows + row_floats(numbers, x_, y_) + number * arena_depth;
    return [this, from](int i, int j) DM_INLINED {
      const auto pair = [&](int row) DM_INLINED {
        const float* at = from + row_floats(numbers, row, j);
        return SquarePick::pair(at, at + row_floats(numbers, 0, 1));
      };
      const SquarePick::Pair first = pair(i), second = pair(i + 1);
      return NodeRow<F>{{pick_[0].of(first, second), pick_[1].of(first, second), pick_[2].of(first, second)}};
    };
  }

 private:
  /// So that all four rows lie in the arena.
  static DM_FN int first_row(float row) { return static_cast<int>(dreampm::min(row, arena_width - 4.0f)); }

  SquarePick pick_[3];
  int x_, y_;
};
#endif

/// Lanes that have nothing in common, as in spray: each loads from its own rows.
class OwnRows {
 public:
  explicit DM_FN OwnRows(const Stencil<F>& s) {
    const F one(1.0f), row = mul_add(s.base[0] + one, F(static_cast<float>(arena_width)), s.base[1] + one);
    const auto first = [&](int numbers) DM_INLINED {
      return mul_add(row, F(static_cast<float>(numbers * arena_depth)), s.base[2] + one);
    };
    store_whole(first(1), one_);
    store_whole(first(4), four_);
  }
  template <int numbers>
  DM_FN auto of(const float* rows, int number) const {
    static_assert(numbers == 1 || numbers == 4);
    const float* const from = rows + number * arena_depth;
    return [this, from](int i, int j) DM_INLINED {
      NodeRow<F> row;
      load_threes(from + row_floats(numbers, i, j), numbers == 1 ? one_ : four_, row.n);
      return row;
    };
  }

 private:
  alignas(64) std::int32_t one_[W], four_[W];  ///< by lane, in rows of so many numbers
};

/// The arenas that the particles of one block gather from.
class Source {
 public:
  explicit DM_FN Source(const BlockPass& pass, bool blocked)
      : field_(pass.in),
        before_(pass.before_in),
        blocked_(blocked ? pass.blocked_in : nullptr),
        full_mass_(pass.step.full_mass),
        shifts_(pass.step.shift > 0) {}

  /// All but `own`, of a vector of particles at `u`.
  template <class M>
  DM_FN void gather_at(const Vec3<F>& u, const Team& team, Gathered<F>& g) const {
    const Stencil<F> s = make_stencil(u);
    if (!team.together) return gather_from<M, 3, 3>(s, team, OwnRows(s), g);
#ifdef __AVX512F__
    gather_from<M, 3, 3>(s, team, SquareRows(s, team), g);
#else
    const SharedRows rows(s, team);
    if (team.wide_x)
      team.wide_y ? gather_from<M, 4, 4>(s, team, rows, g) : gather_from<M, 4, 3>(s, team, rows, g);
    else
      team.wide_y ? gather_from<M, 3, 4>(s, team, rows, g) : gather_from<M, 3, 3>(s, team, rows, g);
#endif
  }

 private:
  template <class M, int nx, int ny, class Rows>
  DM_FN void gather_from(const Stencil<F>& s, const Team& team, const Rows& rows, Gathered<F>& g) const {
    const Shared<F, nx> x = shared<nx>(s, 0, team.x);
    const Shared<F, ny> y = shared<ny>(s, 1, team.y);
    const F(&z)[3] = s.w[2];
    const auto component = [&]<int c>() DM_INLINED {
      constexpr bool liquid = M::info.liquid;
      const Moments<F> m =
          gather<F, liquid ? bend_along(c) : no_bends>(x, y, z, s.t[2], rows.template of<4>(field_, c));
      g.v[c] = m.value;
      for (int a = 0; a < 3; ++a) g.along[a][c] = m.along[a];
      if constexpr (liquid) g.excess = mul_add(m.bend[c], affine_excess(s.t[c]), g.excess);
    };
    component.template operator()<0>(), component.template operator()<1>(), component.template operator()<2>();
    if constexpr (Anchored<M>)
      if (shifts_) g.shift = shift_per_anchoring(x, y, z, s.t, F(full_mass_), rows.template of<4>(field_, 3));
    if constexpr (M::wants_density) g.mass = gather_value<F>(x, y, z, rows.template of<4>(field_, 3));
    if (blocked_) g.blocked = gather_value<F>(x, y, z, rows.template of<1>(blocked_, 0));
    if (before_)
      for (int c = 0; c < 3; ++c) g.before[c] = gather_value<F>(x, y, z, rows.template of<4>(before_, c));
  }
  /// Axis `a` of the stencils among as many nodes from `from` on.
  template <int count>
  static DM_FN Shared<F, count> shared(const Stencil<F>& s, int a, float from) {
    if constexpr (count == 3)
      return Shared<F, 3>(s.w[a], s.t[a]);
    else
      return Shared<F, 4>(s.w[a], s.t[a], s.base[a] > F(from - 0.5f));
  }

  const float *field_, *before_, *blocked_;
  float full_mass_;
  bool shifts_;
};

}  // namespace
}  // namespace dreampm::DM_ISA
