#include "dreampm/solver/projection/pressure.h"

#include <algorithm>
#include <cmath>

#include "dreampm/physics/projection/surface.h"
#include "dreampm/solver/projection/grains.h"
#include "dreampm/solver/projection/wall_images.h"

namespace dreampm {
namespace {

using Row = CellRows::Row;

/// Returns the change of a face's velocity by a field q of cells.
template <class R>
R slope_at(const MacGrid<R>& grid, const R* q, std::size_t axis, std::size_t face, std::size_t below) {
  return slope_across(q[face], q[below], grid.lightness_of(axis, face), grid.depth[face], grid.depth[below]);
}

/// Less than this reaches a face of no particle, and its mean is noise.
constexpr double least_weight = 1e-6;

/// For cells that colliders cut: the part of a kernel that has to be open for its density to tell
/// the depth of the cell, and the least divisor of a density.
constexpr double least_room = 0.5, least_room_read = 0.2;

/// The share of liquid in the matter of a cell that counts as all of it where there is too much.
constexpr double little_liquid = 1.0 / 16;

/// The part of a velocity along axis `a` that goes along the surface of a collider whose inside a
/// face is in: of the normal by the slope of the room around.
template <class R>
R along_surface(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l, std::size_t a) {
  const auto room = [&](std::size_t c) { return grid.room[c]; };
  R slope2 = 0, own = room(at.own + l) - room(at.low[a] + l);
  for (std::size_t t = 0; t < 3; ++t) {
    const R slope = t == a ? own : (room(at.high[t] + l) - room(at.low[t] + l)) / 2;
    slope2 += slope * slope;
  }
  return slope2 > R(0) ? 1 - own * own / slope2 : R(1);
}

/// One layer of faces beside known ones gets their mean; those farther off get what particles
/// brought where `bring_free` says so and they are open.
template <class R>
void extend_layer(MacGrid<R>& grid, std::size_t a, bool bring_free) {
  grid.with_kernels(grid.cells.rows(), [&](const RowKernels<R>& loops, const auto& rows, auto begin, auto end) {
    loops.extend(rows, begin, end, static_cast<int>(a), bring_free);
  });
  LargeVector<R>&v = grid.velocity[a], &next = grid.moving[a];
  if (!grid.room.empty() && bring_free)
    for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
      for (std::size_t l = 0; l < row_cells; ++l) {
        R& out = next[at.own + l];
        if (is_known(v[at.own + l]) || !is_known(out) || grid.open[a][at.own + l] > R(0)) continue;
        const R solid = grid.solid[a].empty() ? R(0) : grid.solid[a][at.own + l];
        out = grid.is_held(a, at.own + l) ? solid : solid + (out - solid) * along_surface(grid, at, l, a);
      }
    });
  v.swap(next);
  grid.wrap(v);
}

/// Returns the filled part of a cell: of its pores, where grains are.
template <class R>
R filling(const MacGrid<R>& grid, std::size_t c) {
  if (grid.grain_volume.empty()) return grid.density[c];
  return (grid.density[c] - grid.grain_volume[c]) /
         (1 - std::min(grid.grain_volume[c], static_cast<R>(GrainNumbers::most_packing)));
}

/// Calls body(place) for the cells beside one that a face which is not closed leads to.
template <class R, class Body>
void for_open_beside(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l, const Body& body) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (grid.open[a][at.own + l] > R(0)) body(at.low[a] + l);
    if (grid.open[a][at.high[a] + l] > R(0)) body(at.high[a] + l);
  }
}

/// Calls body(place, row places, lane) for the cells between the walls of which `is` holds.
template <class R, class Is, class Body>
void for_cells_that(const MacGrid<R>& grid, const Is& is, const Body& body) {
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    const auto [first, last] = grid.lanes_within(row);
    for (int lane = first; lane < last; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (is(at.own + l)) body(at.own + l, at, l);
    }
  });
}

/// Returns the volume of a cell that receding colliders open in a step [cells^3]; negative where
/// they advance. `way`: cells for each m/s.
template <class R>
R opening(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l, R way) {
  if (grid.solid[0].empty()) return 0;
  R sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t low = at.own + l, high = at.high[a] + l;
    sum += (1 - grid.open[a][high]) * grid.solid[a][high] - (1 - grid.open[a][low]) * grid.solid[a][low];
  }
  return sum * way;
}

/// A cell that colliders fill to more than half reads nothing of use: it is as deep as the deepest
/// that it is open to, else water beside it hangs on air. In edges and corners of a vessel those
/// beside it are filled, too. One that a collider leaves with too little liquid is no bubble where
/// all beside it that no collider cuts are liquid. Changes `scratch`, uses `depth`.
template <class R>
void deepen_cut_cells(MacGrid<R>& grid, R way) {
  constexpr R least = static_cast<R>(least_room), least_opening = R(0.05), left = R(0.5), unread = R(2);
  constexpr int to_a_corner = 3;
  LargeVector<R>&depth = grid.scratch, &next = grid.depth;
  for_all_rows(grid.cells.rows(),
               [&](const Row&, const RowPlaces& at) { std::copy_n(&depth[at.own], row_cells, &next[at.own]); });
  for_cells_that(
      grid, [&](std::size_t c) { return grid.room[c] < least || (grid.room[c] < R(1) && !(depth[c] > R(0))); },
      [&](std::size_t c, const RowPlaces& at, std::size_t l) {
        R most = -1, lowest = 1;
        for_open_beside(grid, at, l, [&](std::size_t beside) {
          if (grid.room[beside] < least) return;
          most = std::max(most, depth[beside]);
          if (!(grid.room[beside] < R(1))) lowest = std::min(lowest, depth[beside]);
        });
        if (grid.room[c] < least)
          next[c] = unread;
        else if (lowest > R(0) && most > R(0) && opening(grid, at, l, way) > least_opening)
          next[c] = left;
      });
  depth.swap(next);
  grid.wrap(depth);
  const auto is_unread = [&](std::size_t c) { return depth[c] == unread; };
  for (int pass = 0; pass < to_a_corner; ++pass) {
    for_cells_that(grid, is_unread, [&](std::size_t c, const RowPlaces& at, std::size_t l) {
      R most = -2;
      for_open_beside(grid, at, l,
                      [&](std::size_t beside) { most = std::max(most, is_unread(beside) ? R(-2) : depth[beside]); });
      next[c] = most < R(-1) ? unread : most;
    });
    for_cells_that(grid, is_unread, [&](std::size_t c, const RowPlaces&, std::size_t) { depth[c] = next[c]; });
    grid.wrap(depth);
  }
  // Closed cells are not liquid; an open one here has only filled cells near it: a narrow gap.
  for_cells_that(grid, is_unread, [&](std::size_t c, const RowPlaces& at, std::size_t l) {
    next[c] = -1;
    for_open_beside(grid, at, l, [&](std::size_t) { next[c] = depth_of(filling(grid, c)); });
  });
  for_cells_that(grid, is_unread, [&](std::size_t c, const RowPlaces&, std::size_t) { depth[c] = next[c]; });
}

/// Returns the excess of density of a cell that colliders cut, over the open part of it; the
/// density is read over all cells to which it is open. The smaller the open part, the more of the
/// excess is noise, which is left out.
template <class R>
R cut_excess(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l) {
  constexpr R most_noise = R(0.3), own_weight = R(2);
  R held = 0, room = 0;
  const auto add = [&](std::size_t c, R weight) {
    held += weight * grid.density[c] * std::max(grid.room[c], static_cast<R>(least_room_read));
    room += weight * grid.room[c];
  };
  const std::size_t c = at.own + l;
  add(c, own_weight);
  for (std::size_t a = 0; a < 3; ++a) {
    add(at.low[a] + l, grid.open[a][c]);
    add(at.high[a] + l, grid.open[a][at.high[a] + l]);
  }
  const R excess = held / std::max(room, static_cast<R>(least_room_read)) - 1, noise = most_noise * (1 - grid.room[c]);
  return excess - std::clamp(excess, -noise, noise);
}

}  // namespace

template <class R>
void find_free_velocities(MacGrid<R>& grid, const Vec3d& kick) {
  grid.with_kernels(grid.cells.rows(), [&](const RowKernels<R>& loops, const auto& rows, auto begin, auto end) {
    loops.free_velocities(rows, begin, end, static_cast<Vec3<R>>(kick), static_cast<R>(least_weight));
  });
  for (auto& f : grid.free) grid.wrap(f);
}

template <class R>
void find_depths(MacGrid<R>& grid, double way) {
  for (int axis = 0; axis < 3; ++axis) {
    R* const m = grid.density.data();
    for_images(grid, axis, [&](std::size_t behind, std::size_t before, int count, std::size_t) {
      for (std::size_t l = 0; l < static_cast<std::size_t>(count); ++l) m[before + l] += m[behind + l];
      for (auto* part : {&grid.solid_volume, &grid.grain_volume})
        for (std::size_t l = 0; l < static_cast<std::size_t>(count) && !part->empty(); ++l)
          (*part)[before + l] += (*part)[behind + l];
    });
  }
  const bool cut = !grid.room.empty();
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    const auto [first, last] = grid.lanes_within(row);
    for (int l = first; l < last; ++l) {
      const std::size_t c = at.own + static_cast<std::size_t>(l);
      if (cut) {
        const R room = std::max(grid.room[c], static_cast<R>(least_room_read));
        grid.density[c] /= room;
        for (auto* part : {&grid.solid_volume, &grid.grain_volume})
          if (!part->empty()) (*part)[c] /= room;
      }
      grid.scratch[c] = depth_of(filling(grid, c));
    }
  });
  for (auto* field : {&grid.density, &grid.solid_volume, &grid.grain_volume, &grid.scratch}) grid.wrap(*field);
  if (cut) deepen_cut_cells(grid, static_cast<R>(way)), grid.wrap(grid.scratch);
  // A cell that holds a particle and touches no liquid is a thin one: a drop, a sheet, a film.
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    const auto [first, last] = grid.lanes_within(row);
    const R* const d = grid.scratch.data();
    std::copy_n(d + at.own, row_cells, grid.depth.data() + at.own);
    for (int lane = first; lane < last; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (!grid.held[at.own + l] || d[at.own + l] > R(0)) continue;
      R most = -1;
      for (std::size_t t = 0; t < 3; ++t) most = std::max({most, d[at.low[t] + l], d[at.high[t] + l]});
      if (!(most > R(0))) grid.depth[at.own + l] = static_cast<R>(LiquidSurface::least_depth);
    }
  });
  grid.wrap(grid.depth);
}

template <class R>
void fill_matrix(MacGrid<R>& grid, PressureLevel<R>& matrix) {
  const R* const d = grid.depth.data();
  matrix.rows.clear();
  for (const Row& row : grid.cells.rows()) {
    const R* const own = d + RowPlaces(row).own;
    if (std::any_of(own, own + row_cells, [](R depth) { return depth > R(0); })) matrix.rows.push_back(row);
  }
  const MatrixRows<R> to{
      matrix.diagonal.data(), {matrix.low[0].data(), matrix.low[1].data(), matrix.low[2].data()}, matrix.b.data()};
  grid.with_kernels(matrix.rows, [&](const RowKernels<R>& loops, const auto& rows, auto begin, auto end) {
    loops.matrix(rows, begin, end, to);
  });
}

template <class R>
std::size_t let_go_of_walls(MacGrid<R>& grid, std::span<const Row> rows, const Leaving& leaving) {
  const std::size_t gone = parallel_reduce(rows.size(), std::size_t{0}, [&](std::size_t& count, std::size_t n) {
    const RowPlaces at(rows[n]);
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      const double pull = -static_cast<double>(grid.impulse[c]);
      if (!(grid.depth[c] > R(0)) || !(pull > ProjectionNumbers::least_pull)) continue;
      const Vec3i cell = rows[n].first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
      bool leaves = false;
      for (int a = 0; a < 3; ++a) {
        const auto s = static_cast<std::size_t>(a);
        const auto leaves_by = [&](std::size_t face, bool on_wall, std::size_t wall) {
          if (!(grid.open[s][face] < R(1))) return false;
          if (on_wall) return pull > leaving.walls[wall];
          const std::uint16_t owner = grid.owner[s].empty() ? grid.no_owner : grid.owner[s][face];
          return owner != grid.no_owner && pull > leaving.colliders[owner];
        };
        leaves = leaves || leaves_by(c, cell[a] == grid.low[a], 2 * s) ||
                 leaves_by(at.high[s] + l, cell[a] + 1 == grid.high[a], 2 * s + 1);
      }
      if (leaves) grid.depth[c] = -static_cast<R>(LiquidSurface::least_height), ++count;
    }
  });
  grid.wrap(grid.depth);
  return gone;
}

template <class R>
void add_pressure(MacGrid<R>& grid, double times) {
  const R* const d = grid.depth.data();
  const R* const q = grid.impulse.data();
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t c = at.own + l, below = at.low[a] + l;
        if (!(grid.open[a][c] > R(0)) || !(d[c] > R(0) || d[below] > R(0)) || !is_known(grid.free[a][c])) continue;
        grid.free[a][c] -= static_cast<R>(times) * slope_at(grid, q, a, c, below);
      }
  });
  for (auto& f : grid.free) grid.wrap(f);
}

template <class R>
void apply_pressure(MacGrid<R>& grid, const Leaving& leaving) {
  grid.with_kernels(grid.cells.rows(), [&](const RowKernels<R>& loops, const auto& rows, auto begin, auto end) {
    loops.apply_pressure(rows, begin, end);
  });
  const R* const d = grid.depth.data();
  // On walls.
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      grid.for_on_walls(axis, row, [&](int lane, int wall) {
        const auto l = static_cast<std::size_t>(lane);
        const std::size_t c = at.own + l, below = at.low[a] + l;
        if (grid.open[a][c] > R(0)) return;
        const Vec3i cell = row.first + Vec3i{0, 0, lane};
        const bool high = wall % 2 != 0;
        for (int t = 0; t < 3; ++t)
          if (t != axis && !grid.within(t, cell[t])) return;
        // Liquid that leaves the wall goes on as it was.
        const R free = grid.free[a][c];
        const bool leaves = leaving.walls[static_cast<std::size_t>(wall)] < Leaving::never &&
                            !(d[high ? below : c] > R(0)) && is_known(free) && (high ? free < R(0) : free > R(0));
        grid.velocity[a][c] = leaves ? free : R(0);
      });
    }
  });
  for (auto& f : grid.velocity) grid.wrap(f);
}

template <class R>
void extend_velocities(MacGrid<R>& grid) {
  for (std::size_t a = 0; a < 3; ++a) {
    extend_layer(grid, a, true);
    extend_layer(grid, a, false);
  }
  mirror_along_walls(grid, grid.velocity, grid.holding.walls);
}

template <class R>
void fill_density_source(const MacGrid<R>& grid, PressureLevel<R>& matrix) {
  constexpr R share = R(ProjectionNumbers::density_share), most = R(ProjectionNumbers::most_density);
  for_all_rows(std::span<const Row>(matrix.rows), [&](const Row&, const RowPlaces& at) {
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      const bool cut = !grid.room.empty() && grid.room[c] < R(1);
      const R excess = cut ? cut_excess(grid, at, l) : grid.density[c] - R(1);
      const bool unknown = matrix.diagonal[c] > R(0);
      matrix.b[c] = unknown && (excess > R(0) || grid.is_deep(at, l)) ? std::clamp(share * excess, -most, most) : R(0);
      // Matter beside the liquid keeps its volume by itself, and a little liquid in it gets out.
      if (!grid.solid_volume.empty() && grid.density[c] > R(0)) {
        const R liquid = 1 - grid.solid_volume[c] / grid.density[c];
        matrix.b[c] *= std::clamp(excess > R(0) ? liquid / static_cast<R>(little_liquid) : liquid, R(0), R(1));
      }
      // Only the open part of a cut cell counts.
      if (cut) matrix.b[c] *= grid.room[c];
    }
  });
}

template <class R>
void find_moving_velocities(MacGrid<R>& grid, double dx, double dt) {
  // The first slope of a particle's way is its own velocity, which has no share of it: 2/9 of it.
  const R speed = static_cast<R>(9.0 / 7.0 * dx / dt);
  grid.with_kernels(grid.cells.rows(), [&](const RowKernels<R>& loops, const auto& rows, auto begin, auto end) {
    loops.move(rows, begin, end, grid.displacement.data(), speed);
  });
  for (auto& f : grid.moving) grid.wrap(f);
}

#define DM_INSTANTIATE(R)                                                                  \
  template void find_free_velocities(MacGrid<R>&, const Vec3d&);                           \
  template void find_depths(MacGrid<R>&, double);                                          \
  template void fill_matrix(MacGrid<R>&, PressureLevel<R>&);                               \
  template std::size_t let_go_of_walls(MacGrid<R>&, std::span<const Row>, const Leaving&); \
  template void add_pressure(MacGrid<R>&, double);                                         \
  template void apply_pressure(MacGrid<R>&, const Leaving&);                               \
  template void extend_velocities(MacGrid<R>&);                                            \
  template void fill_density_source(const MacGrid<R>&, PressureLevel<R>&);                 \
  template void find_moving_velocities(MacGrid<R>&, double, double);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
