// Contributions of the particles of a block to the staggered grid, over any lane type. The sums are
// made close together, and added to the grid's in the end.
#pragma once
#include "dreampm/math/four.h"
#include "dreampm/solver/projection/kernels.h"
#include "dreampm/solver/projection/particle_lanes.h"
#include "dreampm/state/grid.h"

namespace dreampm {

/// The sums of a block, until all are made. Two faces that follow one another along z have one
/// place, so that particles of one cell write the same.
struct GivenCells {
  static constexpr int width = block_width + 2, cells = block_width + 1;
  static constexpr int along_z = 4, along_y = cells * along_z, along_x = width * along_y, size = width * along_x;
};
/// The sums at cell centers: eight shares for each cell.
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
  const BlockColumns<const R>& from = block.particles;
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
    given_to_faces(place.way_of_faces(a), Row::load(from.own_velocity[a] + p, n), rise, momenta, weights);
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

/// Adds to two numbers that follow one another.
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

}  // namespace dreampm
