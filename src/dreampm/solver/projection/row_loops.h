// Loops of a step over the faces and cells of its grid, row by row.
#pragma once
#include "dreampm/physics/projection/surface.h"
#include "dreampm/solver/projection/kernels.h"
#include "dreampm/solver/projection/row_lanes.h"

namespace dreampm {

/// The loops, in a type of the instruction set's own.
template <class R, class Isa>
struct RowLoops {
  using Grid = GridRows<R>;
  using S = RowOf<R>;
  using Mask = RowMask<R>;

  static DM_FN S zero() { return S(R(0)); }
  static DM_FN Mask is_known(const S& v) { return v < S(most_known<R>) && v > S(-most_known<R>); }
  static DM_FN S lightness(const Grid& grid, int a, std::size_t face) {
    return grid.lightness[a] ? S::load(grid.lightness[a] + face) : S(R(1));
  }
  /// Returns the change of faces' velocities by a field q of cells.
  static DM_FN S slope(const Grid& grid, const R* q, int a, const RowPlaces& at) {
    const std::size_t below = at.low[a];
    return slope_across(S::load(q + at.own), S::load(q + below), lightness(grid, a, at.own),
                        S::load(grid.depth + at.own), S::load(grid.depth + below));
  }
  /// Returns the mask of the faces that pressure acts on: those at liquid that are open.
  static DM_FN Mask pressed(const Grid& grid, int a, const RowPlaces& at) {
    const Mask at_liquid = S::load(grid.depth + at.own) > zero() || S::load(grid.depth + at.low[a]) > zero();
    return at_liquid && S::load(grid.open[a] + at.own) > zero();
  }

  /// Returns the sums that faces were given.
  static DM_FN FaceSum<S> given(const Grid& grid, int a, std::size_t own) {
    const R* const sums = &grid.sums[a][own].momentum;
    const auto first = S::load(sums).v, second = S::load(sums + row_cells).v;
    return {S(__builtin_shufflevector(first, second, 0, 2, 4, 6, 8, 10, 12, 14)),
            S(__builtin_shufflevector(first, second, 1, 3, 5, 7, 9, 11, 13, 15))};
  }

  static void free_velocities(Grid grid, std::size_t begin, std::size_t end, const Vec3<R>& kick, R least) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t own = RowPlaces(grid.rows[n]).own;
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const auto [momentum, weight] = given(grid, a, own);
        const Mask reached = weight > S(least);
        const S free = momentum / select(reached, weight, S(R(1))) + S(kick[a]);
        select(reached, free, S(unknown_velocity<R>)).store(grid.free[a] + own);
      }
    }
  }

  static void matrix(Grid grid, std::size_t begin, std::size_t end, const MatrixRows<R>& to) {
    for (std::size_t n = begin; n < end; ++n) {
      const RowPlaces at(grid.rows[n]);
      const S depth = S::load(grid.depth + at.own);
      const Mask liquid = depth > zero();
      S diagonal = zero(), inflow = zero();
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const S below = S::load(grid.depth + at.low[a]), above = S::load(grid.depth + at.high[a]);
        const S open = S::load(grid.open[a] + at.own), open_above = S::load(grid.open[a] + at.high[a]);
        const S light = lightness(grid, a, at.own);
        diagonal += open * light * inverse_theta(depth, below) +
                    open_above * lightness(grid, a, at.high[a]) * inverse_theta(depth, above);
        select(liquid && below > zero(), open * light, zero()).store(to.low[a] + at.own);
        const S in = S::load(grid.free[a] + at.own), out = S::load(grid.free[a] + at.high[a]);
        inflow += select(is_known(in), open * in, zero()) - select(is_known(out), open_above * out, zero());
        // A collider that moves brings along what it takes the place of.
        if (grid.solid[a])
          inflow += (S(R(1)) - open) * S::load(grid.solid[a] + at.own) -
                    (S(R(1)) - open_above) * S::load(grid.solid[a] + at.high[a]);
      }
      select(liquid, diagonal, zero()).store(to.diagonal + at.own);
      select(liquid && diagonal > zero(), inflow, zero()).store(to.b + at.own);
    }
  }

  static void apply_pressure(Grid grid, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const RowPlaces at(grid.rows[n]);
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const S free = S::load(grid.free[a] + at.own);
        const S after = select(is_known(free), free, zero()) - slope(grid, grid.impulse, a, at);
        select(pressed(grid, a, at), after, S(unknown_velocity<R>)).store(grid.velocity[a] + at.own);
      }
    }
  }

  static void extend(Grid grid, std::size_t begin, std::size_t end, int a, bool bring_free) {
    const R* const v = grid.velocity[a];
    // Faces between the walls, and those on them.
    Vec3i last = grid.high;
    last[a] += 1;
    for (std::size_t n = begin; n < end; ++n) {
      const CellRows::Row& row = grid.rows[n];
      const RowPlaces at(row);
      const S own = S::load(v + at.own);
      S out = own;
      const bool in =
          row.first.x >= grid.low.x && row.first.x < last.x && row.first.y >= grid.low.y && row.first.y < last.y;
      const Mask wanted = !is_known(own) && Mask::within(grid.low.z - row.first.z, last.z - row.first.z);
      if (in && any(wanted)) {
        S sum = zero(), count = zero();
#pragma GCC unroll 3
        for (int t = 0; t < 3; ++t) {
          const auto add = [&](std::size_t beside) __attribute__((always_inline)) {
            const S u = S::load(v + beside);
            const Mask known = is_known(u);
            sum += select(known, u, zero()), count += select(known, S(R(1)), zero());
          };
          add(at.low[t]), add(at.high[t]);
        }
        const Mask beside = count > zero();
        S far = own;
        if (bring_free) far = select(S::load(grid.open[a] + at.own) > zero(), S::load(grid.free[a] + at.own), own);
        out = select(wanted, select(beside, sum / select(beside, count, S(R(1))), far), own);
      }
      out.store(grid.moving[a] + at.own);
    }
  }

  static void move(Grid grid, std::size_t begin, std::size_t end, const R* displacement, R speed) {
    for (std::size_t n = begin; n < end; ++n) {
      const RowPlaces at(grid.rows[n]);
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const S v = S::load(grid.velocity[a] + at.own);
        select(pressed(grid, a, at), v - slope(grid, displacement, a, at) * S(speed), v).store(grid.moving[a] + at.own);
      }
    }
  }

  static void energies(Grid grid, std::size_t begin, std::size_t end, const Vec3<R>& gained, EnergySums& sums) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t own = RowPlaces(grid.rows[n]).own;
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const auto [momentum, weight] = given(grid, a, own);
        const S free = S::load(grid.free[a] + own), velocity = S::load(grid.velocity[a] + own);
        const Mask known = is_known(free) && weight > zero();
        const S before = momentum / select(known, weight, S(R(1))), after = select(is_known(velocity), velocity, free);
        const auto half_sum = [&](const S& of) __attribute__((always_inline)) {
          const auto v = select(known, of, zero()).v;
          return 0.5 * static_cast<double>(((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])));
        };
        sums.given += half_sum(momentum * before), sums.projected += half_sum(weight * after * after);
        sums.lost += half_sum(weight * (before + after) * (before + S(gained[a]) - after));
      }
    }
  }

  static constexpr RowKernels<R> table{&free_velocities, &matrix, &apply_pressure, &extend, &move, &energies};
};

}  // namespace dreampm
