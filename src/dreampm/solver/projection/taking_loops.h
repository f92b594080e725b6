// Loops in which the particles of a block take from the staggered grid and move, over any lane
// type. The cells around the block are copied to where they lie close together.
#pragma once
#include "dreampm/solver/projection/kernels.h"
#include "dreampm/solver/projection/particle_lanes.h"
#include "dreampm/state/grid.h"

namespace dreampm {

/// Particles that go side by side, in as many vectors as that takes: sums have a place for each, so
/// that they are the same for any number of lanes.
inline constexpr int particle_batch = 16;

/// Cells along each axis that a particle goes in a step at most: two sorts take it two blocks on.
/// It would go further only where the pressure found no solution, as in a vessel with too much
/// water.
inline constexpr double most_way = 7;

/// Cells beyond its block that a particle may be when it is sorted, twice.
inline constexpr double reach_of_sorts = 2 * block_width - 0.01;

/// Squares of speeds that velocities nobody knows are above (unknown_velocity) [m^2/s^2].
inline constexpr double most_known2 = 1e20;

/// Samples around a block, as they lie in an array of `width` columns each way.
template <int columns, int cells>
struct NearCells {
  static constexpr int width = columns, along_y = cells, along_x = columns * cells, size = columns * columns * cells;
};
using StillCells = NearCells<block_width + 2, 8>;
using MovingCells = NearCells<block_width + 2 + 2 * reach_ahead, 12>;

/// Copies a field: the columns from number `first` on of a window of `window` columns each way.
template <class Near, int first, int window, class R>
DM_FN void copy_near(const R* field, const std::size_t* columns, R* to) {
  for (int i = 0; i < Near::width; ++i)
    for (int j = 0; j < Near::width; ++j, to += Near::along_y) {
      const R* const from = field + columns[(i + first) * window + j + first] + first;
      __builtin_memcpy(to, from, Near::along_y * sizeof(R));
    }
}

/// The eight samples around places.
template <class Near, class Row, class S, class R, int lanes>
DM_FN void samples_around(const R* field, const std::int32_t (&number)[lanes], Samples<S>& samples) {
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i)
#pragma GCC unroll 2
    for (int j = 0; j < 2; ++j)
      Row::pairs(field + i * Near::along_x + j * Near::along_y, number, samples.at[i][j][0], samples.at[i][j][1]);
}

/// Replaces the values of the particles in `unknown` by those that look(place, values) finds, one
/// after the other. `x`: their places in cells from the first of the window.
template <class S, class Row, int count, class Look>
DM_FN void look_up(const Vec3<S>& x, unsigned unknown, S* const (&values)[count], const Look& look) {
  using R = Scalar<S>;
  constexpr int lanes = LaneTraits<S>::lanes;
  alignas(64) R places[3][lanes], found[count][lanes];
  for (int a = 0; a < 3; ++a) Row::keep(x[a], places[a]);
  for (int c = 0; c < count; ++c) Row::keep(*values[c], found[c]);
  for (int l = 0; l < lanes; ++l) {
    if (!(unknown >> l & 1)) continue;
    const R at[3] = {places[0][l], places[1][l], places[2][l]};
    R there[count];
    look(at, there);
    for (int c = 0; c < count; ++c) found[c][l] = there[c];
  }
  for (int c = 0; c < count; ++c) *values[c] = Row::all(found[c]);
}

/// The velocity that moves particles, at places in cells from the first of the window.
template <class S, class Row>
DM_FN Vec3<S> moving_at(const BlockTaking<Scalar<S>>& block, const Scalar<S>* near, const Vec3<S>& x, unsigned used) {
  using R = Scalar<S>;
  constexpr int lanes = LaneTraits<S>::lanes;
  // The last place of which all samples are there, and a little less.
  const S begin(R(0.5)), end(R(MovingCells::width) - R(1.0001)), half(R(0.5));
  auto inside = x.x >= begin && x.x < end;
  for (int a = 1; a < 3; ++a) inside = inside && x[a] >= begin && x[a] < end;
  Vec3<S> within;
  for (int a = 0; a < 3; ++a) within[a] = min(max(x[a], begin), end);
  const auto place = StaggeredLanes<S>::at(within, within - Vec3<S>{half, half, half}, Row());
  Vec3<S> v;
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    std::int32_t number[lanes];
    Row::whole(place.number(a, MovingCells::along_x, MovingCells::along_y, 1), number);
    Samples<S> samples;
    samples_around<MovingCells, Row>(near + a * MovingCells::size, number, samples);
    v[a] = trilinear_value(place.way_of_faces(a), samples);
  }
  const auto known = inside && dot(v, v) < S(static_cast<R>(most_known2));
  const unsigned unknown = ~Row::bits(known) & used;
  if (__builtin_expect(unknown != 0, 0)) {
    S* const values[3] = {&v.x, &v.y, &v.z};
    look_up<S, Row>(x, unknown, values,
                    [&](const R(&at)[3], R(&there)[3]) { block.beyond.moving(block.beyond.context, at, there); });
  }
  return v;
}

/// Sums of a block with a place for each particle of a batch.
template <class R>
struct TakenSums {
  alignas(64) R speed2[particle_batch]{}, slope2[particle_batch]{}, fastest2[particle_batch]{};
  double lost = 0;
  bool far = false;
};

/// The motion that particles carry: along each axis the velocity [m/s], and its slopes [1/s].
template <class S>
struct Taken {
  S v[3];
  Vec3<S> slope[3];
};

/// Particles from `p` on, `n` of them.
template <class S, class Row>
DM_FN void take_some(const BlockTaking<Scalar<S>>& block, const Scalar<S>* still, const Scalar<S>* moving,
                     std::size_t p, int n, int slot, TakenSums<Scalar<S>>& sums) {
  using R = Scalar<S>;
  constexpr int lanes = LaneTraits<S>::lanes;
  const BlockColumns<R>& to = block.particles;
  const unsigned used = lanes > 1 ? (1U << n) - 1 : 1U;
  const S half(R(0.5)), offset(R(0.5 + reach_ahead)), known2(static_cast<R>(most_known2)), per_cell(block.per_cell);
  Vec3<S> u;
  for (int a = 0; a < 3; ++a) u[a] = Row::load(to.u[a] + p, n);
  const Vec3<S> start = u + Vec3<S>{offset, offset, offset};
  Taken<S> taken;
  {
    const auto place = StaggeredLanes<S>::at(u + Vec3<S>{half, half, half}, u, Row());
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      std::int32_t number[lanes];
      Row::whole(place.number(a, StillCells::along_x, StillCells::along_y, 1), number);
      Samples<S> samples;
      samples_around<StillCells, Row>(still + a * StillCells::size, number, samples);
      trilinear_slope(place.way_of_faces(a), samples, taken.v[a], taken.slope[a]);
      taken.slope[a] *= per_cell;
    }
  }
  const auto speed2_of = [&]() __attribute__((always_inline)) {
    return taken.v[0] * taken.v[0] + taken.v[1] * taken.v[1] + taken.v[2] * taken.v[2];
  };
  S speed2 = speed2_of();
  unsigned unknown = ~Row::bits(speed2 < known2) & used;
  if (__builtin_expect(unknown != 0, 0)) {
    S* values[12];
    for (int a = 0; a < 3; ++a) {
      values[4 * a] = &taken.v[a];
      for (int t = 0; t < 3; ++t) values[4 * a + 1 + t] = &taken.slope[a][t];
    }
    look_up<S, Row>(start, unknown, values, [&](const R(&at)[3], R(&there)[12]) {
      R found[3][4];
      block.beyond.slope(block.beyond.context, at, found);
      for (int c = 0; c < 12; ++c) there[c] = c % 4 == 0 ? found[c / 4][0] : found[c / 4][c % 4] * block.per_cell;
    });
    const auto known = speed2_of() < known2;
    // It keeps its own motion, and falls.
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      taken.v[a] = select(known, taken.v[a], Row::load(to.own_velocity[axis] + p, n) + S(block.kick[a]));
      for (int t = 0; t < 3; ++t)
        taken.slope[a][t] =
            select(known, taken.slope[a][t], Row::load(to.gradient[3 * axis + static_cast<std::size_t>(t)] + p, n));
    }
    speed2 = speed2_of();
  }
  S slope2(R(0));
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    Row::store(taken.v[a], to.own_velocity[a] + p, n);
#pragma GCC unroll 3
    for (int t = 0; t < 3; ++t) {
      const S slope = taken.slope[a][t];
      Row::store(slope, to.gradient[3 * a + t] + p, n);
      slope2 += slope * slope;
    }
  }
  const auto counts = Row::mask(used);
  const S none(R(0));
  Row::keep(Row::all(sums.speed2 + slot) + select(counts, speed2, none), sums.speed2 + slot);
  Row::keep(Row::all(sums.slope2 + slot) + select(counts, slope2, none), sums.slope2 + slot);
  const S fastest = Row::all(sums.fastest2 + slot);
  Row::keep(select(speed2 < fastest, fastest, speed2), sums.fastest2 + slot);

  const auto hold = [&](Vec3<S>& x) __attribute__((always_inline)) {
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      const S least(block.least[a]), most(block.most[a]);
      x[a] = select(x[a] < least, least, x[a]);
      x[a] = select(x[a] > most, most, x[a]);
    }
  };
  const Vec3<S> first{taken.v[0], taken.v[1], taken.v[2]};
  const auto slope_after = [&](const Vec3<S>& from, R part) __attribute__((always_inline)) {
    Vec3<S> x = start + from * S(part * block.way);
    hold(x);
    const Vec3<S> v = moving_at<S, Row>(block, moving, x, used);
    return select(dot(v, v) < known2, v, from);
  };
  const Vec3<S> second = slope_after(first, R(0.5)), third = slope_after(second, R(0.75));
  const Vec3<S> gone = (first * S(R(2)) + second * S(R(3)) + third * S(R(4))) * S(block.way / R(9));
  const S furthest(static_cast<R>(most_way));
  Vec3<S> end;
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    S way = select(gone[a] < -furthest, -furthest, gone[a]);
    way = select(way > furthest, furthest, way);
    end[a] = start[a] + way;
  }
  hold(end);
  if (block.beyond.put_out) {
    alignas(64) R from[3][lanes], places[3][lanes];
    for (int a = 0; a < 3; ++a) Row::keep(start[a], from[a]), Row::keep(end[a], places[a]);
    for (int l = 0; l < n; ++l) {
      const R began[3] = {from[0][l], from[1][l], from[2][l]};
      R x[3] = {places[0][l], places[1][l], places[2][l]};
      sums.lost += block.beyond.put_out(block.beyond.context, p + static_cast<std::size_t>(l), began, x);
      for (int a = 0; a < 3; ++a) places[a][l] = x[a];
    }
    for (int a = 0; a < 3; ++a) end[a] = Row::all(places[a]);
    hold(end);
  }
  auto near = Row::mask(~0U);
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    // Sorts take none further.
    const S least(static_cast<R>(-reach_of_sorts)), most(static_cast<R>(block_width + reach_of_sorts));
    S x = end[a] - offset;
    x = select(x < least, least, x), x = select(x > most, most, x);
    near = near && x > S(R(-block_width)) && x < S(R(2 * block_width));
    Row::store(x, to.u[a] + p, n);
  }
  sums.far = sums.far || (~Row::bits(near) & used) != 0;
}

template <class S, class Row>
DM_FN void take_particles(const BlockTaking<Scalar<S>>& block, BlockMove& found) {
  using R = Scalar<S>;
  constexpr int lanes = LaneTraits<S>::lanes;
  alignas(64) R still[3 * StillCells::size], moving[3 * MovingCells::size];
  for (int a = 0; a < 3; ++a) {
    copy_near<StillCells, reach_ahead, MovingCells::width>(block.velocity[a], block.columns,
                                                           still + a * StillCells::size);
    copy_near<MovingCells, 0, MovingCells::width>(block.moving[a], block.columns, moving + a * MovingCells::size);
  }
  TakenSums<R> sums;
  int slot = 0;
  for (std::size_t p = block.particles.begin; p < block.particles.end; p += lanes) {
    const std::size_t left = block.particles.end - p;
    take_some<S, Row>(block, still, moving, p, left < lanes ? static_cast<int>(left) : lanes, slot, sums);
    slot = (slot + lanes) % particle_batch;
  }
  double fastest2 = 0, speed2 = 0, slope2 = 0;
  for (int n = 0; n < particle_batch; ++n) {
    speed2 += static_cast<double>(sums.speed2[n]), slope2 += static_cast<double>(sums.slope2[n]);
    const auto fast = static_cast<double>(sums.fastest2[n]);
    fastest2 = fast < fastest2 ? fastest2 : fast;
  }
  found = {fastest2, speed2, slope2, sums.lost, speed2 - speed2 == 0, sums.far};
}

}  // namespace dreampm
