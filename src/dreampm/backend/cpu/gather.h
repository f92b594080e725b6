// How a vector of particles gathers from an arena: one particle a lane, since particles that lie in
// one row along z pick from the same nodes.
#pragma once
#include "dreampm/backend/cpu/kernel.h"
#include "dreampm/math/lanes.h"

/// An attribute of lambdas, which cannot have DM_FN.
#define DM_INLINED __attribute__((always_inline))

namespace dreampm::DM_ISA {
namespace {

using F = Lanes<float>;
constexpr int W = F::count;

constexpr bool rows_side_by_side = W == 16;

/// The lane group of a vector of particles at `u`, as in ParticleSet::u.
DM_FN LaneGroup lane_group_of(const Vec3<F>& u) {
  LaneGroup group;
  group.together = true;
  const auto first_along = [&](int a) DM_INLINED { return round_int(u[a] - F(0.5f)); };  // as make_stencil() does
#pragma GCC unroll 2
  for (int a = 0; a < 2; ++a) {
    const F row = first_along(a);
    const float some = lane0(row);
    // Among whole numbers only 0 and 1 equal their square, and only 0 and -1 the negative of it.
    const F from_some = row - F(some), square = from_some * from_some;
    const bool before = any(square != from_some), after = any(square != -from_some);
    group.first[a] = static_cast<std::int16_t>(static_cast<int>(some) + 1 - before);
    group.wide[a] = before | after;
    group.together &= !(before & after);
  }
  if constexpr (!rows_side_by_side) {
    // The first four of the six places from -1 to 4, the last, or those between.
    const F place = first_along(2);
    const bool to_2 = !any(place > F(2.5f)), to_3 = !any(place > F(3.5f));
    const bool from_0 = !any(place < F(-0.5f)), from_1 = !any(place < F(0.5f));
    group.first[2] = static_cast<std::int16_t>(to_2 ? -1 : from_1 ? 1 : 0);
    group.together &= to_2 | from_1 | (from_0 & to_3);
  }
  return group;
}

// The sources of rows for gather(): of(arena, number).

#ifndef DM_SIXTEEN_LANES
/// Lanes whose stencils begin in the same rows, of two by two, pick from the same splines, four
/// along z.
class SharedRows {
 public:
  DM_FN SharedRows(const Stencil<F>& s, const LaneGroup& group)
      : first_{group.first[0], group.first[1], group.first[2]},
        pick_(s.base[2] - F(static_cast<float>(group.first[2]))) {}
  DM_FN auto of(const float* splines, int number) const {
    using At = BlockSplines;
    const float* const from = splines + At::at(first_[0], number, 0, first_[1]) + first_[2] + 2;
    return [this, from](int i, int j) DM_INLINED {
      const auto part = [&](int k) DM_INLINED { return pick_.of(from + At::at(i, 0, k, j)); };
      return LineSpline<F>{part(0), part(1), part(2)};
    };
  }

 private:
  int first_[3];
  FourPick pick_;
};
#else
/// Lanes whose stencils begin in two rows by two: each picks from two rows side by side, or four,
/// what is its own. `beside`: the axis along which they lie so, of x and y. `wide`: whether some
/// begin at the second row across.
template <int beside, bool wide>
class SharedRows {
 public:
  DM_FN SharedRows(const Stencil<F>& s, const LaneGroup& group)
      : first_{group.first[1 - beside], group.first[beside]}, pick_(index(s)) {}
  DM_FN auto of(const float* splines, int number) const {
    using At = BlockSplines;
    const float* const from = splines + At::at(first_[0], number, 0, first_[1]);
    return [this, from](int i, int j) DM_INLINED {
      const auto part = [&](int k) DM_INLINED {
        const float* at = from + (beside == 0 ? At::at(j, 0, k, i) : At::at(i, 0, k, j));
        if constexpr (wide)
          return pick_.of(at, at + At::at(1, 0, 0, 0));
        else
          return pick_.of(at);
      };
      return LineSpline<F>{part(0), part(1), part(2)};
    };
  }

 private:
  DM_FN F index(const Stencil<F>& s) const {
    const auto second = [&](int axis, int first, float rows) DM_INLINED {
      return select(s.base[axis] > F(static_cast<float>(first) - 0.5f), F(rows), F(0.0f));
    };
    const F row = s.base[2] + F(2.0f) + second(beside, first_[1], 8.0f);
    if constexpr (wide)
      return row + second(1 - beside, first_[0], 16.0f);
    else
      return row;
  }
  int first_[2];
  SquarePick pick_;
};
#endif

/// Lanes that have nothing in common, as in spray: each loads from its own rows.
class OwnRows {
 public:
  DM_FN OwnRows(const Stencil<F>& s, int beside) : step_{At::step(0, beside), At::step(1, beside)} {
    const F one(1.0f), z = s.base[2] + one;
    const auto from = [&](int a) DM_INLINED { return F(static_cast<float>(step_[a])); };
    store_whole(mul_add(s.base[0] + one, from(0), mul_add(s.base[1] + one, from(1), z)), first_);
  }
  DM_FN auto of(const float* splines, int number) const {
    const float* const from = splines + At::at(0, number, 0, 0);
    return [this, from](int i, int j) DM_INLINED {
      NodeRow<F> row;
      load_threes(from + i * step_[0] + j * step_[1], first_, row.n);
      return line_spline<F>(row.n[0], row.n[1], row.n[2]);
    };
  }

 private:
  using At = BlockSplines;
  int step_[2];                        ///< by axis
  alignas(64) std::int32_t first_[W];  ///< by lane
};

/// The quantities that a pass gathers besides velocities and their slopes.
struct Wants {
  bool affine_excess;  ///< as in G2PResult,
  bool density;        ///< content, and what is blocked of it,
  bool density_state;
};
template <class M, bool relaxes>
inline constexpr Wants wants_of{M::info.liquid, measures<M>(relaxes ? 1.0f : 0.0f), VolumeRelaxed<M> ? relaxes : false};

/// The arenas that the particles of one block gather from.
class Source {
 public:
  explicit DM_FN Source(const BlockPass& pass)
      : splines_{pass.in, pass.velocity_old_in, pass.mixture_in, pass.clearance_in},
        full_(pass.step.full),
        filled_(pass.by_volume && pass.mixture_in ? 1 + pass.own_field : 0),
        beside_(pass.beside) {}

  /// Gathers for a vector of particles at `u` in a plain pass.
  template <Wants wants>
  DM_FN void gather_at(const Vec3<F>& u, const LaneGroup& group, G2PResult<F>& g) const {
    if (group.together) {
      const Stencil<F> s = make_stencil(u);
      over_shared_rows(s, group, [&](const auto& x, const auto& y, const auto& rows) DM_INLINED {
        gather_from<wants>(s, x, y, rows, g);
      });
    } else {
      // A copy, as an object that a call gets by reference stays in memory everywhere.
      const Source source = *this;
      const Vec3<F> at = u;
      G2PResult<F> own;
      source.gather_own<wants>(at, own);
      g = own;
    }
  }
  /// Gathers all but `own` for any pass, in one function for all kernels that want the same:
  /// inlined in each, it is half of all code to compile.
  template <Wants wants>
  __attribute__((noinline)) void gather_apart(const Vec3<F>& u, const LaneGroup& group, G2PResult<F>& g) const {
    gather_at<wants>(u, group, g);
    if (splines_.clearance || splines_.velocity_old) gather_rare(u, group, g);
  }

 private:
  /// The fields to gather from: velocities and masses of a field, its velocities before forces, the
  /// mixture, and the clearance.
  struct Fields {
    const float *field, *velocity_old, *mixture, *clearance;
  };

  /// Calls body(x, y, rows): the stencils along x and y among the nodes that the lanes have
  /// together, and those rows.
  template <class Body>
  DM_FN void over_shared_rows(const Stencil<F>& s, const LaneGroup& group, const Body& body) const {
#ifdef DM_SIXTEEN_LANES
    const auto over = [&]<int beside, bool wide>() DM_INLINED {
      body(shared<3>(s, 0, group.first[0]), shared<3>(s, 1, group.first[1]), SharedRows<beside, wide>(s, group));
    };
    if (beside_ == 0)
      group.wide[1] ? over.template operator()<0, true>() : over.template operator()<0, false>();
    else
      group.wide[0] ? over.template operator()<1, true>() : over.template operator()<1, false>();
#else
    const SharedRows rows(s, group);
    const auto over = [&]<int nx, int ny>() DM_INLINED {
      body(shared<nx>(s, 0, group.first[0]), shared<ny>(s, 1, group.first[1]), rows);
    };
    if (group.wide[0])
      group.wide[1] ? over.template operator()<4, 4>() : over.template operator()<4, 3>();
    else
      group.wide[1] ? over.template operator()<3, 4>() : over.template operator()<3, 3>();
#endif
  }

  /// Apart from the rest, which its many rows would push out of the registers.
  template <Wants wants>
  __attribute__((noinline)) void gather_own(const Vec3<F>& u, G2PResult<F>& g) const {
    const Stencil<F> s = make_stencil(u);
    gather_from<wants>(s, shared<3>(s, 0, 0), shared<3>(s, 1, 0), OwnRows(s, beside_), g);
  }
  /// Obstacles, and velocities before forces: once for all materials and kernels.
  __attribute__((noinline)) void gather_rare(const Vec3<F>& u, const LaneGroup& group, G2PResult<F>& g) const {
    const Stencil<F> s = make_stencil(u);
    const LinePlace<F> z(s.t[2]);
    const auto from = [&](const auto& x, const auto& y, const auto& rows) DM_INLINED {
      const auto value = [&](const float* field, int number)
                             DM_INLINED { return gather_value<F>(x, y, z, rows.of(field, number)); };
      if (splines_.clearance) {
        for (int c = 0; c < 3; ++c) g.clearance_gradient[c] = value(splines_.clearance, c);
        g.clearance = value(splines_.clearance, 3);
      }
      if (splines_.velocity_old)
        for (int c = 0; c < 3; ++c) g.velocity_old[c] = value(splines_.velocity_old, c);
    };
    if (group.together)
      over_shared_rows(s, group, from);
    else
      from(shared<3>(s, 0, 0), shared<3>(s, 1, 0), OwnRows(s, beside_));
  }

  template <Wants wants, int nx, int ny, class Rows>
  DM_FN void gather_from(const Stencil<F>& s, const Shared<F, nx>& x, const Shared<F, ny>& y, const Rows& rows,
                         G2PResult<F>& g) const {
    const Fields& from = splines_;
    const LinePlace<F> z(s.t[2]);
    const auto component = [&]<int c>() DM_INLINED {
      const Moments<F> m = gather<F, wants.affine_excess ? bend_along(c) : no_bends>(x, y, z, rows.of(from.field, c));
      g.v[c] = m.value;
      for (int a = 0; a < 3; ++a) g.affine_moment[a][c] = m.first_moment[a];
      if constexpr (wants.affine_excess) {
        const F excess = affine_excess(s.t[c]);
        g.affine_excess = c == 0 ? m.bend[c] * excess : mul_add(m.bend[c], excess, g.affine_excess);
      }
    };
    component.template operator()<0>(), component.template operator()<1>(), component.template operator()<2>();
    if constexpr (wants.density) {
      const auto content = filled_ ? rows.of(from.mixture, filled_) : rows.of(from.field, 3);
      if constexpr (wants.density_state) {
        const F full(full_);
        g.density_state = from.mixture ? density_state(x, y, z, s.t, full, content, rows.of(from.mixture, 0))
                                       : density_state(x, y, z, s.t, full, content);
        g.node_content = g.density_state.node_content;
      } else {
        g.node_content = gather_value<F>(x, y, z, content);
      }
      g.blocked = wants.affine_excess && from.mixture ? gather_value<F>(x, y, z, rows.of(from.mixture, 0)) : F();
    }
  }
  /// Axis `a` of the stencils among as many nodes from `from` on.
  template <int count>
  static DM_FN Shared<F, count> shared(const Stencil<F>& s, int a, int from) {
    if constexpr (count == 3)
      return Shared<F, 3>(s.w[a], s.t[a]);
    else
      return Shared<F, 4>(s.w[a], s.t[a], s.base[a] > F(static_cast<float>(from) - 0.5f));
  }

  Fields splines_;
  float full_;  ///< as in SetStep
  int filled_;  ///< the number of the mixture that a density is measured by; 0: by mass
  int beside_;
};

}  // namespace
}  // namespace dreampm::DM_ISA
