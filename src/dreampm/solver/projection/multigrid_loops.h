// The loops of the multigrid over rows of eight cells, each a vector of eight numbers.
#pragma once
#include "dreampm/math/four.h"
#include "dreampm/math/scalar.h"
#include "dreampm/solver/projection/kernels.h"

namespace dreampm {

template <class R>
DM_FN void load_eight(const R* from, Eight<R>& to) {
  __builtin_memcpy(&to, from, sizeof to);
}
template <class R>
DM_FN void store_eight(const Eight<R>& from, R* to) {
  __builtin_memcpy(to, &from, sizeof from);
}
/// Adds the products of floats or doubles, in doubles.
template <class R>
DM_FN void add_products(const Eight<R>& a, const Eight<R>& b, Eight<double>& sum) {
  sum += __builtin_convertvector(a, Eight<double>) * __builtin_convertvector(b, Eight<double>);
}
DM_FN double sum_of_eight(const Eight<double>& v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

/// The couplings of a row's cells times the values beside them.
template <class R>
DM_FN void neighbors_of(const LevelRows<R>& level, const R* x, const CellRows::Row& row, Eight<R>& sum) {
  const RowPlaces at(row);
  const std::size_t c = at.own;
  const R *ax = level.low[0], *ay = level.low[1], *az = level.low[2];
  const auto product = [](const R* coupling, const R* value, Eight<R>& to) __attribute__((always_inline)) {
    Eight<R> v;
    load_eight(coupling, to), load_eight(value, v);
    to *= v;
  };
  Eight<R> part;
  product(ax + c, x + at.low[0], sum);
  product(ax + at.high[0], x + at.high[0], part), sum += part;
  product(ay + c, x + at.low[1], part), sum += part;
  product(ay + at.high[1], x + at.high[1], part), sum += part;
  // Out of the row itself: a vector that begins in the row before, which may have just been
  // written, would have to wait until that is in memory.
  Eight<R> own, before = Eight<R>{} + x[c - 1], after = Eight<R>{} + x[c + row_cells], coupling;
  load_eight(x + c, own);
  load_eight(az + c, coupling), sum += coupling * __builtin_shufflevector(before, own, 0, 8, 9, 10, 11, 12, 13, 14);
  load_eight(az + c + 1, coupling), sum += coupling * __builtin_shufflevector(own, after, 1, 2, 3, 4, 5, 6, 7, 8);
}

/// Merges eight numbers: those of even places from `even`, the others from `odd`.
template <class R>
DM_FN void alternate(const Eight<R>& even, const Eight<R>& odd, Eight<R>& to) {
  to = __builtin_shufflevector(even, odd, 0, 9, 2, 11, 4, 13, 6, 15);
}
/// True if the cells of a color are those of even places in a row.
DM_FN bool is_even(const CellRows::Row& row, int color) { return ((row.first.x + row.first.y + color) & 1) == 0; }

/// Half a sweep of Gauss and Seidel of one row: its cells of a color, which see only those of the
/// other. These are written with the values that they have, while other threads may read them.
template <class R>
DM_FN void relax(const LevelRows<R>& level, const CellRows::Row& row, int color, Eight<R>& x, Eight<R>& b) {
  const std::size_t c = row_place(row.number);
  Eight<R> beside, inverse, old;
  neighbors_of<R>(level, level.x, row, beside);
  load_eight(level.b + c, b), load_eight(level.inverse + c, inverse), load_eight(level.x + c, old);
  const Eight<R> relaxed = inverse * (b + beside);
  if (is_even(row, color))
    alternate<R>(relaxed, old, x);
  else
    alternate<R>(old, relaxed, x);
  store_eight(x, level.x + c);
}

/// b - A x of a row.
template <class R>
DM_FN void residual_of(const LevelRows<R>& level, const R* x, const CellRows::Row& row, Eight<R>& r) {
  const std::size_t c = row_place(row.number);
  Eight<R> beside, diagonal, own;
  neighbors_of<R>(level, x, row, beside);
  load_eight(level.b + c, r), load_eight(level.diagonal + c, diagonal), load_eight(x + c, own);
  r = r - diagonal * own + beside;
}

/// The loops, in a type of the instruction set's own.
template <class R, class Isa>
struct MultigridLoops {
  using Level = LevelRows<R>;
  static void first_half_sweep(Level level, std::size_t begin, std::size_t end, int color) {
    for (std::size_t n = begin; n < end; ++n) {
      const CellRows::Row& row = level.rows[n];
      const std::size_t c = row_place(row.number);
      Eight<R> x, b;
      load_eight(level.inverse + c, x), load_eight(level.b + c, b);
      x *= b;
      if (is_even(row, color))
        alternate<R>(x, Eight<R>{}, x);
      else
        alternate<R>(Eight<R>{}, x, x);
      store_eight(x, level.x + c);
    }
  }
  static void half_sweep(Level level, std::size_t begin, std::size_t end, int color) {
    for (std::size_t n = begin; n < end; ++n) {
      Eight<R> x, b;
      relax<R>(level, level.rows[n], color, x, b);
    }
  }
  static double last_half_sweep(Level level, std::size_t begin, std::size_t end, int color) {
    Eight<double> sum{};
    for (std::size_t n = begin; n < end; ++n) {
      Eight<R> x, b;
      relax<R>(level, level.rows[n], color, x, b);
      add_products<R>(x, b, sum);
    }
    return sum_of_eight(sum);
  }
  static void residual(Level level, std::size_t begin, std::size_t end, R* to) {
    for (std::size_t n = begin; n < end; ++n) {
      Eight<R> r;
      residual_of<R>(level, level.x, level.rows[n], r);
      store_eight(r, to + row_place(level.rows[n].number));
    }
  }
  static double take_off(Level level, std::size_t begin, std::size_t end, const R* x) {
    Eight<double> sum{};
    for (std::size_t n = begin; n < end; ++n) {
      Eight<R> r;
      residual_of<R>(level, x, level.rows[n], r);
      store_eight(r, level.b + row_place(level.rows[n].number));
      add_products<R>(r, r, sum);
    }
    return sum_of_eight(sum);
  }
  static double product(Level level, std::size_t begin, std::size_t end, const R* x, R* y) {
    Eight<double> sum{};
    for (std::size_t n = begin; n < end; ++n) {
      const CellRows::Row& row = level.rows[n];
      const std::size_t c = row_place(row.number);
      Eight<R> beside, diagonal, own;
      neighbors_of<R>(level, x, row, beside);
      load_eight(level.diagonal + c, diagonal), load_eight(x + c, own);
      const Eight<R> product = diagonal * own - beside;
      store_eight(product, y + c);
      add_products<R>(own, product, sum);
    }
    return sum_of_eight(sum);
  }
  static void turn(Level level, std::size_t begin, std::size_t end, R beta, R* direction) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t c = row_place(level.rows[n].number);
      Eight<R> x, d;
      load_eight(level.x + c, x), load_eight(direction + c, d);
      store_eight<R>(x + beta * d, direction + c);
    }
  }
  static double advance(Level level, std::size_t begin, std::size_t end, R alpha, const R* direction, const R* product,
                        R* x) {
    Eight<double> sum{};
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t c = row_place(level.rows[n].number);
      Eight<R> own, d, b, p;
      load_eight(x + c, own), load_eight(direction + c, d), load_eight(level.b + c, b), load_eight(product + c, p);
      store_eight<R>(own + alpha * d, x + c);
      b = b - alpha * p;
      store_eight(b, level.b + c);
      add_products<R>(b, b, sum);
    }
    return sum_of_eight(sum);
  }
  static void gather(Level coarse, std::size_t begin, std::size_t end, const std::array<std::uint32_t, 8>* children,
                     const R* r) {
    for (std::size_t n = begin; n < end; ++n) {
      Eight<R> low, high, part;
      const auto& of = children[n];
      load_eight(r + row_place(of[0]), low), load_eight(r + row_place(of[1]), high);
#pragma GCC unroll 3
      for (std::size_t c = 2; c < 8; c += 2) {
        load_eight(r + row_place(of[c]), part), low += part;
        load_eight(r + row_place(of[c + 1]), part), high += part;
      }
      store_eight<R>(__builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14) +
                         __builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15),
                     coarse.b + row_place(coarse.rows[n].number));
    }
  }
  static void coarsen(Level fine, Level coarse, const MatrixRows<R>& to, std::size_t begin, std::size_t end,
                      const std::array<std::uint32_t, 8>* children, R scale) {
    const Eight<R> odd{0, 2, 0, 2, 0, 2, 0, 2};
    for (std::size_t n = begin; n < end; ++n) {
      // The lower and the upper four aggregates of the row.
      Eight<R> diagonal[2]{}, low[3][2]{};
#pragma GCC unroll 8
      for (std::size_t part = 0; part < 8; ++part) {
        const std::size_t i = part >> 2, j = part >> 1 & 1, half = part & 1, f = row_place(children[n][part]);
        Eight<R> d, x, y, z;
        load_eight(fine.diagonal + f, d), load_eight(fine.low[0] + f, x), load_eight(fine.low[1] + f, y),
            load_eight(fine.low[2] + f, z);
        // A coupling within the aggregate leaves the diagonal, for both of its cells.
        d -= odd * z;
        if (i == 1)
          d -= x + x;
        else
          low[0][half] += x;
        if (j == 1)
          d -= y + y;
        else
          low[1][half] += y;
        low[2][half] += z;
        diagonal[half] += d;
      }
      const std::size_t c = row_place(coarse.rows[n].number);
      const auto even = [](const Eight<R>(&v)[2], Eight<R>& found) __attribute__((always_inline)) {
        found = __builtin_shufflevector(v[0], v[1], 0, 2, 4, 6, 8, 10, 12, 14);
      };
      const auto both = [&](const Eight<R>(&v)[2], Eight<R>& found) __attribute__((always_inline)) {
        even(v, found), found += __builtin_shufflevector(v[0], v[1], 1, 3, 5, 7, 9, 11, 13, 15);
      };
      Eight<R> sum;
      both(diagonal, sum), store_eight<R>(scale * sum, to.diagonal + c);
      both(low[0], sum), store_eight<R>(scale * sum, to.low[0] + c);
      both(low[1], sum), store_eight<R>(scale * sum, to.low[1] + c);
      even(low[2], sum), store_eight<R>(scale * sum, to.low[2] + c);
    }
  }
  static void invert(Level level, std::size_t begin, std::size_t end, R* to) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t c = row_place(level.rows[n].number);
      Eight<R> d;
      load_eight(level.diagonal + c, d);
      const auto is = d > R(0);
      store_eight<R>(is ? R(1) / (is ? d : Eight<R>{} + R(1)) : Eight<R>{}, to + c);
    }
  }
  static void spread(Level fine, std::size_t begin, std::size_t end, const std::uint32_t* parents, const R* coarse) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t c = row_place(fine.rows[n].number);
      Eight<R> x, diagonal;
      Eight<R> from{};
      __builtin_memcpy(&from, coarse + parents[n], 4 * sizeof(R));
      from = __builtin_shufflevector(from, from, 0, 0, 1, 1, 2, 2, 3, 3);
      load_eight(fine.x + c, x), load_eight(fine.diagonal + c, diagonal);
      store_eight<R>(x + (diagonal > R(0) ? from : Eight<R>{}), fine.x + c);
    }
  }
  static constexpr MultigridKernels<R> table{&first_half_sweep, &half_sweep, &last_half_sweep, &residual, &take_off,
                                             &product,          &turn,       &advance,         &gather,   &coarsen,
                                             &invert,           &spread};
};

}  // namespace dreampm
