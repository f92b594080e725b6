// What particles of a block give to the staggered grid and take from it, over any lane type: a
// particle a lane. The cells around the block are copied to where they lie close together.
#pragma once
#include <cmath>

#include "dreampm/solver/projection/kernels.h"
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

// `Row` handles as many particles as S has lanes, as OneParticle does for plain numbers.

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

/// Among which samples of a staggered grid places lie: faces of an axis are half a cell before
/// centers along it.
template <class S>
struct StaggeredLanes {
  Vec3<S> face, center;          ///< whole numbers: the samples on the low side
  Vec3<S> face_way, center_way;  ///< from there [cells]
  /// `x`: in cells from a corner of cells, `middle`: from a center of cells; both 0 or more.
  template <class Row>
  static DM_FN StaggeredLanes at(const Vec3<S>& x, const Vec3<S>& middle, Row) {
    StaggeredLanes place;
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      place.face[a] = Row::floor(x[a]), place.center[a] = Row::floor(middle[a]);
      place.face_way[a] = x[a] - place.face[a], place.center_way[a] = middle[a] - place.center[a];
    }
    return place;
  }
  DM_FN Vec3<S> way_of_faces(int axis) const {
    Vec3<S> way = center_way;
    way[axis] = face_way[axis];
    return way;
  }
  /// The place in an array with these strides; `axis` -1: of centers.
  DM_FN S number(int axis, int along_x, int along_y, int along_z) const {
    const auto at = [&](int a) __attribute__((always_inline)) { return a == axis ? face[a] : center[a]; };
    using R = Scalar<S>;
    return at(0) * S(static_cast<R>(along_x)) + at(1) * S(static_cast<R>(along_y)) + at(2) * S(static_cast<R>(along_z));
  }
};

/// The eight samples around places.
template <class Near, class Row, class S, class R, int lanes>
DM_FN void samples_around(const R* field, const std::int32_t (&number)[lanes], Samples<S>& samples) {
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i)
#pragma GCC unroll 2
    for (int j = 0; j < 2; ++j)
      Row::pairs(field + i * Near::along_x + j * Near::along_y, number, samples.at[i][j][0], samples.at[i][j][1]);
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
    alignas(64) R places[3][lanes], found[3][lanes];
    for (int a = 0; a < 3; ++a) Row::keep(x[a], places[a]), Row::keep(v[a], found[a]);
    for (int l = 0; l < lanes; ++l) {
      if (!(unknown >> l & 1)) continue;
      const R at[3] = {places[0][l], places[1][l], places[2][l]};
      R there[3];
      block.beyond.moving(block.beyond.context, at, there);
      for (int a = 0; a < 3; ++a) found[a][l] = there[a];
    }
    for (int a = 0; a < 3; ++a) v[a] = Row::all(found[a]);
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

/// What particles carry: along each axis the velocity [m/s], and its slopes [1/s].
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
    alignas(64) R places[3][lanes], found[3][4][lanes];
    for (int a = 0; a < 3; ++a) {
      Row::keep(start[a], places[a]), Row::keep(taken.v[a], found[a][0]);
      for (int t = 0; t < 3; ++t) Row::keep(taken.slope[a][t], found[a][t + 1]);
    }
    for (int l = 0; l < lanes; ++l) {
      if (!(unknown >> l & 1)) continue;
      const R at[3] = {places[0][l], places[1][l], places[2][l]};
      R there[3][4];
      block.beyond.slope(block.beyond.context, at, there);
      for (int a = 0; a < 3; ++a)
        for (int t = 0; t < 4; ++t) found[a][t][l] = t == 0 ? there[a][t] : there[a][t] * block.per_cell;
    }
    for (int a = 0; a < 3; ++a) {
      taken.v[a] = Row::all(found[a][0]);
      for (int t = 0; t < 3; ++t) taken.slope[a][t] = Row::all(found[a][t + 1]);
    }
    const auto known = speed2_of() < known2;
    // It keeps its own motion, and falls.
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      taken.v[a] = select(known, taken.v[a], Row::load(to.own[axis] + p, n) + S(block.kick[a]));
      for (int t = 0; t < 3; ++t)
        taken.slope[a][t] =
            select(known, taken.slope[a][t], Row::load(to.gradient[3 * axis + static_cast<std::size_t>(t)] + p, n));
    }
    speed2 = speed2_of();
  }
  S slope2(R(0));
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    Row::store(taken.v[a], to.own[a] + p, n);
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

/// Where the sums of a block lie until all are made. Of faces two that follow one another along z
/// have one place, so that particles of one cell write the same.
struct GivenCells {
  static constexpr int width = block_width + 2, cells = block_width + 1;
  static constexpr int along_z = 4, along_y = cells * along_z, along_x = width * along_y, size = width * along_x;
};
/// And those of centers: eight shares for each cell.
struct GivenCenters {
  static constexpr int cells = block_width + 1;
  static constexpr int along_z = 8, along_y = cells * along_z, along_x = cells * along_y, size = cells * along_x;
};

template <class R>
struct GivenSums {
  alignas(64) R faces[3][GivenCells::size]{};
  alignas(64) R centers[GivenCenters::size]{};
  std::uint8_t held[GivenCenters::size / GivenCenters::along_z]{};
};

template <class R>
DM_FN void add_four(const R* from, R* to) {
  Four<R> a, b;
  load<R>(from, a), load<R>(to, b);
  store<R>(b + a, to);
}

template <class S, class Row>
DM_FN void give_some(const BlockGiving<Scalar<S>>& block, std::size_t p, int n, GivenSums<Scalar<S>>& sums) {
  using R = Scalar<S>;
  constexpr int lanes = LaneTraits<S>::lanes;
  const BlockColumns<R>& from = block.particles;
  const S half(R(0.5)), dx(block.dx), volume(block.volume);
  Vec3<S> u;
  for (int a = 0; a < 3; ++a) u[a] = Row::load(from.u[a] + p, n);
  const auto place = StaggeredLanes<S>::at(u + Vec3<S>{half, half, half}, u, Row());
  alignas(64) R given[3][4][4 * lanes], shares[2][4 * lanes];
  std::int32_t faces[3][lanes], centers[lanes], cells[lanes];
#pragma GCC unroll 3
  for (int a = 0; a < 3; ++a) {
    Row::whole(place.number(a, GivenCells::along_x, GivenCells::along_y, GivenCells::along_z), faces[a]);
    Vec3<S> rise;
    for (int t = 0; t < 3; ++t) rise[t] = Row::load(from.gradient[3 * a + t] + p, n) * dx;
    Samples<S> momenta, weights;
    given_to_faces(place.way_of_faces(a), Row::load(from.own[a] + p, n), rise, momenta, weights);
#pragma GCC unroll 4
    for (int c = 0; c < 4; ++c) {
      const S(&m)[2] = momenta.at[c >> 1][c & 1], (&w)[2] = weights.at[c >> 1][c & 1];
      Row::records(m[0], w[0], m[1], w[1], given[a][c]);
    }
  }
  Row::whole(place.number(-1, GivenCenters::along_x, GivenCenters::along_y, GivenCenters::along_z), centers);
  constexpr int per_x = GivenCenters::cells * GivenCenters::cells, per_y = GivenCenters::cells;
  Row::whole(place.face.x * S(R(per_x)) + place.face.y * S(R(per_y)) + place.face.z, cells);
  Samples<S> share;
  trilinear_shares(place.center_way, share);
#pragma GCC unroll 2
  for (int i = 0; i < 2; ++i) {
    const S(&s)[2][2] = share.at[i];
    Row::records(s[0][0] * volume, s[0][1] * volume, s[1][0] * volume, s[1][1] * volume, shares[i]);
  }
  for (int l = 0; l < n; ++l) {
    const int record = 4 * Row::record_of(l);
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      R* const to = sums.faces[a] + faces[a][l];
#pragma GCC unroll 4
      for (int c = 0; c < 4; ++c)
        add_four(given[a][c] + record, to + (c >> 1) * GivenCells::along_x + (c & 1) * GivenCells::along_y);
    }
    R* const to = sums.centers + centers[l];
    add_four(shares[0] + record, to), add_four(shares[1] + record, to + 4);
    sums.held[cells[l]] = 1;
  }
}

/// Two numbers that follow one another.
template <class R>
struct TwoOf {
  using Type [[gnu::vector_size(2 * sizeof(R))]] = R;
};
template <class R>
using Two = typename TwoOf<R>::Type;

/// Adds to two of them.
template <class R>
DM_FN void add_two(const Two<R>& a, R* to) {
  Two<R> sum;
  __builtin_memcpy(&sum, to, sizeof sum);
  sum += a;
  __builtin_memcpy(to, &sum, sizeof sum);
}

/// Adds what a block's particles gave to the grid. Where nothing was given there may be no cell.
template <class R>
DM_FN void add_given(const BlockGiving<R>& block, const GivenSums<R>& sums) {
  using At = GivenCells;
  const auto two = [](const R* from) __attribute__((always_inline)) {
    Two<R> v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
  };
  for (int i = 0; i < At::width; ++i)
    for (int j = 0; j < At::width; ++j) {
      const std::size_t column = block.columns[i * At::width + j];
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const R* const from = sums.faces[a] + i * At::along_x + j * At::along_y;
        FaceSum<R>* const to = block.sums[a] + column;
#pragma GCC unroll 6
        for (int k = 0; k < At::width; ++k) {
          Two<R> sum{};
          if (k < At::cells) sum = two(from + 4 * k);
          if (k > 0) sum += two(from + 4 * k - 2);
          if (sum[1] != R(0)) add_two<R>(sum, &to[k].momentum);
        }
      }
    }
  using Centers = GivenCenters;
  for (int i = 0; i < Centers::cells; ++i)
    for (int j = 0; j < Centers::cells; ++j) {
      R* to[4];
      for (int c = 0; c < 4; ++c) to[c] = block.density + block.columns[(i + (c >> 1)) * At::width + j + (c & 1)];
      for (int k = 0; k < Centers::cells; ++k) {
        const R* const from = sums.centers + i * Centers::along_x + j * Centers::along_y + k * Centers::along_z;
        Two<R> shares[4], all{};
#pragma GCC unroll 4
        for (int c = 0; c < 4; ++c) shares[c] = two(from + 2 * c), all += shares[c];
        if (all[0] + all[1] == R(0)) continue;
#pragma GCC unroll 4
        for (int c = 0; c < 4; ++c) add_two<R>(shares[c], to[c] + k);
      }
      std::uint8_t* const held = block.held + block.columns[i * At::width + j];
      const std::uint8_t* const of = sums.held + (i * Centers::cells + j) * Centers::cells;
      for (int k = 0; k < Centers::cells; ++k)
        if (of[k]) held[k] = 1;
    }
}

/// Fetches where a block's sums will go: particles take long enough.
template <class R>
DM_FN void fetch_sums(const BlockGiving<R>& block) {
  for (int c = 0; c < GivenCells::width * GivenCells::width; ++c) {
    for (const FaceSum<R>* const sums : block.sums) {
      const FaceSum<R>* const at = sums + block.columns[c];
      __builtin_prefetch(at, 1), __builtin_prefetch(at + GivenCells::width - 1, 1);
    }
    __builtin_prefetch(block.density + block.columns[c], 1);
  }
}

template <class S, class Row>
DM_FN void give_particles(const BlockGiving<Scalar<S>>& block) {
  constexpr int lanes = LaneTraits<S>::lanes;
  fetch_sums(block);
  GivenSums<Scalar<S>> sums;
  for (std::size_t p = block.particles.begin; p < block.particles.end; p += lanes) {
    const std::size_t left = block.particles.end - p;
    give_some<S, Row>(block, p, left < lanes ? static_cast<int>(left) : lanes, sums);
  }
  add_given(block, sums);
}

template <class R>
struct OneParticle {
  static R load(const R* p, int) { return *p; }
  static void store(R a, R* p, int) { *p = a; }
  static R all(const R* p) { return *p; }
  static void keep(R a, R* p) { *p = a; }
  static R floor(R a) { return std::floor(a); }
  static void whole(R a, std::int32_t (&to)[1]) { to[0] = static_cast<std::int32_t>(a); }
  static void pairs(const R* from, const std::int32_t (&number)[1], R& first, R& second) {
    first = from[number[0]], second = from[number[0] + 1];
  }
  static unsigned bits(bool m) { return m; }
  static bool mask(unsigned bits) { return (bits & 1) != 0; }
  static void records(R a, R b, R c, R d, R* p) { p[0] = a, p[1] = b, p[2] = c, p[3] = d; }
  static int record_of(int) { return 0; }
};

}  // namespace dreampm
