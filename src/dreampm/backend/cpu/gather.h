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

/// Lanes that gather together: their stencils begin in two rows of the arena by two.
struct Team {
  LaneMask here;
  float x, y;           ///< the first of the rows
  bool wide_x, wide_y;  ///< whether some stencils begin at the second

  Team() = default;
  /// As many of the lanes `left` as can be with those that begin farthest down x. `first`: nodes of the arena.
  DM_FN Team(const F& first_x, const F& first_y, LaneMask left) {
    const F far(1e9f), half(0.5f);
    x = smallest(select(left, first_x, far));
    const F dx = first_x - F(x);
    here = left && dx < F(1.5f);
    y = smallest(select(here, first_y, far));
    const F dy = first_y - F(y);
    here = here && dy < F(1.5f);
    wide_x = any(here && dx > half);
    wide_y = any(here && dy > half);
  }
  /// All the lanes of a vector at `u` that can be together.
  explicit DM_FN Team(const Vec3<F>& u) : Team(first_node(u.x), first_node(u.y), first_lanes(W)) {}

  /// As make_stencil() does, in the arena.
  static DM_FN F first_node(const F& u) { return round_int(u - F(0.5f)) + F(1.0f); }
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

  /// All but `own`, of a vector of particles at `u`. `first`: of all lanes; those that it leaves follow in others.
  template <class M>
  DM_FN void gather_at(const Vec3<F>& u, const Team& first, Gathered<F>& g) const {
    const Stencil<F> s = make_stencil(u);
    const F one(1.0f), z = s.base[2] + one;
    const RowPick pick[3] = {RowPick(z), RowPick(z + one), RowPick(z + one + one)};
    if (first.wide_x)
      first.wide_y ? gather_team<M, 4, 4>(s, first, pick, g) : gather_team<M, 4, 3>(s, first, pick, g);
    else
      first.wide_y ? gather_team<M, 3, 4>(s, first, pick, g) : gather_team<M, 3, 3>(s, first, pick, g);
    LaneMask left = !first.here;
    while (any(left)) {
      const Team team(s.base[0] + one, s.base[1] + one, left);
      gather_team<M, 4, 4>(s, team, pick, g);
      left = left && !team.here;
    }
  }

 private:
  template <class M, int nx, int ny>
  DM_FN void gather_team(const Stencil<F>& s, const Team& team, const RowPick (&pick)[3], Gathered<F>& g) const {
    const Shared<F, nx> x = shared<nx>(s, 0, team.x);
    const Shared<F, ny> y = shared<ny>(s, 1, team.y);
    const F(&z)[3] = s.w[2];
    const int row = static_cast<int>(team.x) * arena_width + static_cast<int>(team.y);
    const auto take = [&](F& to, F found) DM_INLINED { to = select(team.here, found, to); };
    F excess;
    const auto component = [&]<int c>() DM_INLINED {
      constexpr bool liquid = M::info.liquid;
      const Moments<F> m =
          gather<F, liquid ? bend_along(c) : no_bends>(x, y, z, s.t[2], rows_of<4>(field_, row, c, pick));
      take(g.v[c], m.value);
      for (int a = 0; a < 3; ++a) take(g.along[a][c], m.along[a]);
      if constexpr (liquid) excess = mul_add(m.bend[c], affine_excess(s.t[c]), excess);
    };
    component.template operator()<0>(), component.template operator()<1>(), component.template operator()<2>();
    if constexpr (M::info.liquid) take(g.excess, excess);
    if constexpr (Anchored<M>)
      if (shifts_) {
        const auto mass = rows_of<4>(field_, row, 3, pick);
        const Vec3<F> shift = shift_per_anchoring(x, y, z, s.t, F(full_mass_), mass);
        for (int a = 0; a < 3; ++a) take(g.shift[a], shift[a]);
      }
    if constexpr (M::wants_density) take(g.mass, gather_value<F>(x, y, z, rows_of<4>(field_, row, 3, pick)));
    if (blocked_) take(g.blocked, gather_value<F>(x, y, z, rows_of<1>(blocked_, row, 0, pick)));
    if (before_)
      for (int c = 0; c < 3; ++c) take(g.before[c], gather_value<F>(x, y, z, rows_of<4>(before_, row, c, pick)));
  }
  /// Axis `a` of the stencils among as many nodes from `from` on.
  template <int count>
  static DM_FN Shared<F, count> shared(const Stencil<F>& s, int a, float from) {
    if constexpr (count == 3)
      return Shared<F, 3>(s.w[a], s.t[a]);
    else
      return Shared<F, 4>(s.w[a], s.t[a], s.base[a] > F(from - 0.5f));
  }
  /// For gather(): the rows of component `c`.
  template <int numbers>
  static DM_FN auto rows_of(const float* rows, int first, int c, const RowPick (&pick)[3]) {
    const float* const from = rows + first * ArenaRows<numbers>::row_floats + c * arena_depth;
    return [&pick, from](int i, int j) DM_INLINED {
      const float* at = from + (i * arena_width + j) * ArenaRows<numbers>::row_floats;
      return NodeRow<F>{{pick[0].of(at), pick[1].of(at), pick[2].of(at)}};
    };
  }

  const float *field_, *before_, *blocked_;
  float full_mass_;
  bool shifts_;
};

}  // namespace
}  // namespace dreampm::DM_ISA
