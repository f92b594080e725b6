#include "dreampm/solver/projection/pressure.h"

#include <algorithm>
#include <cmath>

#include "dreampm/physics/projection/surface.h"
#include "dreampm/solver/projection/wall_images.h"

namespace dreampm {
namespace {

using Row = CellRows::Row;

/// What a field q of cells takes from the velocity of a face.
template <class R>
R slope_at(const MacGrid<R>& grid, const R* q, std::size_t axis, std::size_t face, std::size_t below) {
  return (q[face] - q[below]) * grid.lightness_of(axis, face) * inverse_theta(grid.depth[face], grid.depth[below]);
}

/// Less than this reaches a face of no particle, and its mean is noise.
constexpr double least_weight = 1e-6;

/// Of cells that colliders cut: how much of a kernel has to be open for its density to say how deep
/// the cell lies, and what a density is divided by at least.
constexpr double least_room = 0.5, least_room_read = 0.2;

/// Of the matter in a cell: liquid that counts as all of it where there is too much.
constexpr double little_liquid = 1.0 / 16;

/// Of a cell: the most that grains take, however they are pressed.
constexpr double most_grains = 0.85;

/// Velocities behind walls become those before them, or their opposite where the wall holds liquids
/// so that they are 0 on it; axis by axis, so that edges and corners follow.
template <class R>
void mirror_velocities(MacGrid<R>& grid) {
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t a = 0; a < 3; ++a) {
      if (static_cast<int>(a) == axis) continue;
      R* const v = grid.velocity[a].data();
      for_images(grid, axis, [&](std::size_t behind, std::size_t before, int count, std::size_t wall) {
        if (behind < 2 * row_cells) return;  // no row there
        const R turn = grid.holding.walls[wall] ? R(-1) : R(1);
        for (std::size_t n = 0; n < static_cast<std::size_t>(count); ++n) v[behind + n] = turn * v[before + n];
      });
    }
}

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
  LargeVector<R>&v = grid.velocity[a], &next = grid.moving[a];
  const auto axis = static_cast<int>(a);
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    R* const out = next.data() + at.own;
    std::copy_n(v.data() + at.own, row_cells, out);
    // Faces between the walls, and those on them.
    Vec3i last = grid.high;
    last[axis] += 1;
    if (row.first.x < grid.low.x || row.first.x >= last.x || row.first.y < grid.low.y || row.first.y >= last.y) return;
    const int begin = std::max(grid.low.z - row.first.z, 0), end = std::min(last.z - row.first.z, row_cells);
    for (int lane = begin; lane < end; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      if (is_known(v[at.own + l])) continue;
      R sum = 0;
      int count = 0;
      for (std::size_t t = 0; t < 3; ++t)
        for (const std::size_t side : {at.low[t] + l, at.high[t] + l})
          if (is_known(v[side])) sum += v[side], ++count;
      if (count > 0) {
        out[l] = sum / static_cast<R>(count);
        if (!grid.room.empty() && bring_free && !(grid.open[a][at.own + l] > R(0))) {
          const R solid = grid.solid[a].empty() ? R(0) : grid.solid[a][at.own + l];
          out[l] = grid.is_held(a, at.own + l) ? solid : solid + (out[l] - solid) * along_surface(grid, at, l, a);
        }
      } else if (bring_free && grid.open[a][at.own + l] > R(0)) {
        out[l] = grid.free[a][at.own + l];
      }
    }
  });
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    std::copy_n(next.data() + at.own, row_cells, v.data() + at.own);
  });
  grid.wrap(v);
}

/// How full a cell is: of its pores, where grains are.
template <class R>
R filling(const MacGrid<R>& grid, std::size_t c) {
  if (grid.grain_volume.empty()) return grid.density[c];
  return (grid.density[c] - grid.grain_volume[c]) / (1 - std::min(grid.grain_volume[c], static_cast<R>(most_grains)));
}

/// A cell that colliders fill to more than half reads nothing of use: it is as deep as the deepest
/// that it is open to, else water beside it hangs on air. One that a moving collider has just left
/// with too little liquid is no bubble where all beside it that no collider cuts are liquid.
template <class R>
void deepen_cut_cells(MacGrid<R>& grid) {
  constexpr R least = static_cast<R>(least_room), left = R(0.5);
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    std::copy_n(grid.scratch.data() + at.own, row_cells, grid.depth.data() + at.own);
    const auto [first, last] = grid.lanes_within(row);
    for (int lane = first; lane < last; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      const std::size_t c = at.own + l;
      const bool filled = grid.room[c] < least, empty = grid.room[c] < R(1) && !(grid.scratch[c] > R(0));
      if (!filled && !empty) continue;
      R most = -1, lowest = 1;
      for (std::size_t a = 0; a < 3; ++a)
        for (const bool high : {false, true}) {
          const std::size_t beside = (high ? at.high[a] : at.low[a]) + l;
          if (!(grid.open[a][high ? beside : c] > R(0)) || grid.room[beside] < least) continue;
          most = std::max(most, grid.scratch[beside]);
          if (!(grid.room[beside] < R(1))) lowest = std::min(lowest, grid.scratch[beside]);
        }
      if (filled)
        grid.depth[c] = most;
      else if (lowest > R(0) && most > R(0))
        grid.depth[c] = left;
    }
  });
  grid.scratch.swap(grid.depth);
}

}  // namespace

template <class R>
void find_free_velocities(MacGrid<R>& grid, const Vec3d& kick) {
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const R gain = static_cast<R>(kick[static_cast<int>(a)]);
      for (std::size_t c = at.own; c < at.own + row_cells; ++c) {
        const auto [momentum, w] = grid.sums[a][c];
        const bool reached = w > static_cast<R>(least_weight);
        grid.free[a][c] = reached ? momentum / (reached ? w : R(1)) + gain : unknown_velocity<R>;
      }
    }
  });
  for (auto& f : grid.free) grid.wrap(f);
}

template <class R>
void find_depths(MacGrid<R>& grid) {
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
  if (cut) deepen_cut_cells(grid), grid.wrap(grid.scratch);
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
void fill_matrix(const MacGrid<R>& grid, PressureLevel<R>& matrix) {
  const R* const d = grid.depth.data();
  const bool moves = !grid.solid[0].empty();
  matrix.rows.clear();
  for (const Row& row : grid.cells.rows()) {
    const R* const own = d + RowPlaces(row).own;
    if (std::any_of(own, own + row_cells, [](R depth) { return depth > R(0); })) matrix.rows.push_back(row);
  }
  for_all_rows(std::span<const Row>(matrix.rows), [&](const Row&, const RowPlaces& at) {
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      const bool liquid = d[c] > R(0);
      R diagonal = 0, inflow = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t below = at.low[a] + l, above = at.high[a] + l;
        const R open = grid.open[a][c], open_above = grid.open[a][above];
        const R light = grid.lightness_of(a, c);
        diagonal += open * light * inverse_theta(d[c], d[below]) +
                    open_above * grid.lightness_of(a, above) * inverse_theta(d[c], d[above]);
        matrix.low[a][c] = liquid && d[below] > R(0) ? open * light : R(0);
        const R in = grid.free[a][c], out = grid.free[a][above];
        inflow += (is_known(in) ? open * in : R(0)) - (is_known(out) ? open_above * out : R(0));
        // A collider that moves brings along what it takes the place of.
        if (moves) inflow += (1 - open) * grid.solid[a][c] - (1 - open_above) * grid.solid[a][above];
      }
      matrix.diagonal[c] = liquid ? diagonal : R(0);
      matrix.b[c] = liquid && diagonal > R(0) ? inflow : R(0);
    }
  });
}

template <class R>
std::size_t let_go_of_walls(MacGrid<R>& grid, const Leaving& leaving) {
  const std::span<const Row> rows = grid.cells.rows();
  const std::size_t gone = parallel_reduce(rows.size(), std::size_t{0}, [&](std::size_t& count, std::size_t n) {
    const RowPlaces at(rows[n]);
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      if (!(grid.depth[c] > R(0)) || !(grid.impulse[c] < -static_cast<R>(ProjectionNumbers::least_pull))) continue;
      const Vec3i cell = rows[n].first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
      bool may = false;
      for (int a = 0; a < 3; ++a) {
        const auto s = static_cast<std::size_t>(a);
        const auto leaves = [&](std::size_t face, bool on_wall, std::size_t wall) {
          return grid.open[s][face] < R(1) && (on_wall ? leaving.walls[wall] : leaving.colliders);
        };
        may = may || leaves(c, cell[a] == grid.low[a], 2 * s) ||
              leaves(at.high[s] + l, cell[a] + 1 == grid.high[a], 2 * s + 1);
      }
      if (may) grid.depth[c] = -static_cast<R>(LiquidSurface::least_height), ++count;
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
  const R* const d = grid.depth.data();
  const R* const q = grid.impulse.data();
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t c = at.own + l, below = at.low[a] + l;
        if (grid.open[a][c] > R(0)) {
          if (!(d[c] > R(0) || d[below] > R(0))) continue;
          const R free = grid.free[a][c];
          grid.velocity[a][c] = (is_known(free) ? free : R(0)) - slope_at(grid, q, a, c, below);
          continue;
        }
        const Vec3i cell = row.first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
        const bool high = cell[axis] == grid.high[axis];
        bool on_wall = high || cell[axis] == grid.low[axis];
        for (int t = 0; t < 3; ++t) on_wall = on_wall && (t == axis || grid.within(t, cell[t]));
        if (!on_wall) continue;
        // What leaves the wall goes on as it was.
        const R free = grid.free[a][c];
        const bool leaves = leaving.walls[2 * a + (high ? 1 : 0)] && !(d[high ? below : c] > R(0)) && is_known(free) &&
                            (high ? free < R(0) : free > R(0));
        grid.velocity[a][c] = leaves ? free : R(0);
      }
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
  mirror_velocities(grid);
  for (auto& f : grid.velocity) grid.wrap(f);
}

template <class R>
void fill_density_source(const MacGrid<R>& grid, PressureLevel<R>& matrix) {
  const R* const d = grid.depth.data();
  constexpr R share = R(ProjectionNumbers::density_share), most = R(ProjectionNumbers::most_density);
  for_all_rows(std::span<const Row>(matrix.rows), [&](const Row&, const RowPlaces& at) {
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      const R excess = grid.density[c] - R(1);
      bool deep = true;
      for (std::size_t a = 0; a < 3; ++a) {
        deep = deep && (d[at.low[a] + l] > R(0) || !(grid.open[a][c] > R(0)));
        deep = deep && (d[at.high[a] + l] > R(0) || !(grid.open[a][at.high[a] + l] > R(0)));
      }
      const bool unknown = matrix.diagonal[c] > R(0);
      matrix.b[c] = unknown && (excess > R(0) || deep) ? std::clamp(share * excess, -most, most) : R(0);
      // What lies beside the liquid keeps its volume by itself, and a little liquid in it gets out.
      if (!grid.solid_volume.empty() && grid.density[c] > R(0)) {
        const R liquid = 1 - grid.solid_volume[c] / grid.density[c];
        matrix.b[c] *= std::clamp(excess > R(0) ? liquid / static_cast<R>(little_liquid) : liquid, R(0), R(1));
      }
      // Of a cut cell only the open part counts; where little is open the reading is noise.
      if (!grid.room.empty()) {
        constexpr R least = R(least_room);
        matrix.b[c] *= std::min(grid.room[c], std::max((grid.room[c] - least) / (1 - least), R(0)));
      }
    }
  });
}

template <class R>
void find_moving_velocities(MacGrid<R>& grid, double dx, double dt) {
  // The first slope of a particle's way is its own velocity, which has no share of it: 2/9 of it.
  const R speed = static_cast<R>(9.0 / 7.0 * dx / dt);
  const R* const d = grid.depth.data();
  const R* const q = grid.displacement.data();
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t c = at.own + l, below = at.low[a] + l;
        const bool at_liquid = (d[c] > R(0) || d[below] > R(0)) && grid.open[a][c] > R(0);
        const R v = grid.velocity[a][c];
        grid.moving[a][c] = at_liquid ? v - slope_at(grid, q, a, c, below) * speed : v;
      }
  });
  for (auto& f : grid.moving) grid.wrap(f);
}

#define DM_INSTANTIATE(R)                                                  \
  template void find_free_velocities(MacGrid<R>&, const Vec3d&);           \
  template void find_depths(MacGrid<R>&);                                  \
  template void fill_matrix(const MacGrid<R>&, PressureLevel<R>&);         \
  template std::size_t let_go_of_walls(MacGrid<R>&, const Leaving&);       \
  template void add_pressure(MacGrid<R>&, double);                         \
  template void apply_pressure(MacGrid<R>&, const Leaving&);               \
  template void extend_velocities(MacGrid<R>&);                            \
  template void fill_density_source(const MacGrid<R>&, PressureLevel<R>&); \
  template void find_moving_velocities(MacGrid<R>&, double, double);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
