#include "dreampm/solver/projection/step_sums.h"

#include <algorithm>

#include "dreampm/state/mechanics.h"

namespace dreampm {
namespace {

/// The middle of the low face of a cell along an axis [m].
template <class R>
Vec3d low_face(const World<R>& world, const Vec3i& cell, int axis) {
  return world.node_position(cell) + face_middle(axis, false) * world.dx;
}

/// An impulse along an axis [N s], through a place, on what moves there with a speed along the axis
/// [m/s].
void add_along(ImpulseSum& to, int axis, double impulse, const Vec3d& at, double speed) {
  Vec3d received{};
  received[axis] = impulse;
  to.impulse[axis] += impulse, to.angular += cross(at, received), to.work += impulse * speed;
}

using Walls = std::array<ImpulseSum, 6>;

/// The impulses on walls and colliders, by their numbers.
struct Contacts {
  decltype(GridStats::colliders) colliders;
  Walls walls{};

  explicit Contacts(std::size_t count = 0) { colliders.resize(count); }
  void add_to(GridStats& to) const {
    to.colliders.resize(colliders.size());
    for (std::size_t c = 0; c < colliders.size(); ++c) to.colliders[c] += colliders[c];
    for (std::size_t w = 0; w < 6; ++w) to.walls[w] += walls[w];
  }
};
struct JoinContacts {
  void operator()(Contacts& all, const Contacts& from) const {
    for (std::size_t c = 0; c < from.colliders.size(); ++c) all.colliders[c] += from.colliders[c];
    for (std::size_t w = 0; w < 6; ++w) all.walls[w] += from.walls[w];
  }
};

/// Adds the impulses of viscosity on walls, and on faces of colliders that hold the liquid.
template <class R>
void add_viscous_contact(const World<R>& world, const MacGrid<R>& grid, const Viscosity<R>& viscosity,
                         const StepScale& scale, GridStats& to) {
  if (!viscosity.acts()) return;
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  const Contacts sum = parallel_reduce(
      rows.size(), Contacts(world.colliders.size()),
      [&](Contacts& sums, std::size_t n) {
        const RowPlaces at(rows[n]);
        for (int a = 0; a < 3; ++a) {
          const auto axis = static_cast<std::size_t>(a);
          const int b = (a + 1) % 3, c = (a + 2) % 3;
          for (int lane = 0; lane < row_cells; ++lane) {
            const Vec3i face = rows[n].first + Vec3i{0, 0, lane};
            if (!grid.within(b, face[b]) || !grid.within(c, face[c])) continue;
            const std::size_t place = at.own + static_cast<std::size_t>(lane);
            const double across = -static_cast<double>(viscosity.given_to(axis, place)) * scale.cell;
            const int wall = grid.wall_at(a, face[a]);
            if (wall >= 0) {
              ImpulseSum& on_wall = sums.walls[static_cast<std::size_t>(wall)];
              if (across != 0) add_along(on_wall, a, across, low_face(world, face, a), 0);
              for (const int along : {b, c}) {
                const int edge = 3 - a - along;
                const double shear = static_cast<double>(viscosity.shear(static_cast<std::size_t>(edge), place));
                Vec3d middle{};
                middle[edge] = 0.5;
                if (shear != 0)
                  add_along(on_wall, along, (wall % 2 ? shear : -shear) * scale.cell,
                            world.node_position(face) + middle * world.dx, 0);
              }
            } else if (across != 0 && grid.within(a, face[a]) && grid.is_held(axis, place)) {
              const double speed = grid.solid[axis].empty() ? 0 : static_cast<double>(grid.solid[axis][place]);
              add_along(sums.colliders[grid.owner[axis][place]], a, across, low_face(world, face, a), speed);
            }
          }
        }
      },
      JoinContacts{});
  sum.add_to(to);
}

}  // namespace

template <class R>
void add_contact(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut, const Viscosity<R>& viscosity,
                 const StepScale& scale, GridStats& to) {
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  const auto liquid = [&](std::size_t place) {
    return grid.depth[place] > R(0) ? static_cast<double>(grid.impulse[place] - viscosity.pull(place)) : 0.0;
  };
  const Walls walls = parallel_reduce(
      rows.size(), Walls{},
      [&](Walls& sum, std::size_t n) {
        const RowPlaces at(rows[n]);
        for (int a = 0; a < 3; ++a) {
          const auto axis = static_cast<std::size_t>(a);
          grid.for_on_walls(a, rows[n], [&](int lane, int wall) {
            const Vec3i face = rows[n].first + Vec3i{0, 0, lane};
            const std::size_t place = at.own + static_cast<std::size_t>(lane),
                              below = at.low[axis] + static_cast<std::size_t>(lane);
            const R free = grid.free[axis][place], weight = grid.sums[axis][place].weight;
            const double stopped =
                is_known(free) ? static_cast<double>(weight * (grid.velocity[axis][place] - free)) * scale.particle : 0;
            const double pressed = wall % 2 ? -liquid(below) : liquid(place);
            if (stopped != 0 || pressed != 0)
              add_along(sum[static_cast<std::size_t>(wall)], a, stopped + pressed * scale.cell,
                        low_face(world, face, a), 0);
          });
        }
      },
      [](Walls& sum, const Walls& from) {
        for (std::size_t w = 0; w < 6; ++w) sum[w] += from[w];
      });
  for (std::size_t w = 0; w < 6; ++w) to.walls[w] += walls[w];

  add_viscous_contact(world, grid, viscosity, scale, to);
  if (world.colliders.empty()) return;
  const auto slope = [&](std::size_t place) {
    return pressure_slope(static_cast<double>(grid.depth[place]), scale.kick);
  };
  const auto pressure = [&](std::size_t place, const Vec3d& way) { return liquid(place) + dot(slope(place), way); };
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  const Contacts sum = parallel_reduce(
      blocks.size(), Contacts(world.colliders.size()),
      [&](Contacts& to_block, std::size_t b) {
        cut.for_closed(grid, blocks[b], [&](const typename CutCells<R>::ClosedFace& face) {
          const int a = face.axis;
          Vec3i below = face.cell;
          below[a] -= 1;
          const double q = pressure(face.place, face.way(true)) - pressure(grid.cells.place_of(below), face.way(false));
          if (q == 0) return;
          const auto axis = static_cast<std::size_t>(a);
          const double speed = grid.solid[axis].empty() ? 0 : static_cast<double>(grid.solid[axis][face.place]);
          const Vec3d at = world.node_position(face.cell) + face.middle * world.dx;
          const double impulse = q * face.closed * scale.cell;
          add_along(to_block.colliders[face.owner], a, impulse, at, speed);
          for (const bool high : {false, true}) {
            if (face.cell[a] != (high ? grid.high[a] : grid.low[a])) continue;
            const Vec3d way = face_middle(a, high) - Vec3d{0.5, 0.5, 0.5};
            const double hidden =
                pressure(high ? grid.cells.place_of(below) : face.place, way) * face.closed * scale.cell;
            add_along(to_block.walls[2 * axis + (high ? 1 : 0)], a, high ? hidden : -hidden, at, 0);
          }
        });
        cut.for_filled(grid, blocks[b], [&](const typename CutCells<R>::FilledCell& cell) {
          const Vec3d impulse = slope(cell.place) * (cell.filled * scale.cell);
          if (impulse == Vec3d{}) return;
          const Vec3d at = world.node_position(cell.cell) + cell.middle * world.dx;
          ImpulseSum& to_collider = to_block.colliders[cell.owner];
          to_collider.impulse += impulse, to_collider.angular += cross(at, impulse);
          to_collider.work += dot(impulse, world.colliders[cell.owner].velocity(at));
        });
      },
      JoinContacts{});
  sum.add_to(to);
}

template <class R>
FaceSums face_sums(const World<R>& world, MacGrid<R>& grid, const StepScale& scale) {
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  const GridRows<R> as_rows = grid.as_rows(rows);
  constexpr std::size_t rows_at_once = 64;
  const Vec3<R> gained = static_cast<Vec3<R>>(scale.kick);
  return parallel_reduce(
      (rows.size() + rows_at_once - 1) / rows_at_once, FaceSums{},
      [&](FaceSums& sum, std::size_t piece) {
        const std::size_t begin = piece * rows_at_once, end = std::min(rows.size(), begin + rows_at_once);
        grid.kernels->energies(as_rows, begin, end, gained, sum.energy);
        for (std::size_t n = begin; n < end; ++n) {
          const std::size_t own = RowPlaces(rows[n]).own;
          // Trilinear weights keep places.
          double mass = 0, along = 0;
          for (std::size_t l = 0; l < row_cells; ++l) {
            double m = static_cast<double>(grid.sums[0][own + l].weight) * scale.particle;
            if (!grid.solid_volume.empty()) m += static_cast<double>(grid.solid_sums[0][own + l].weight) * scale.cell;
            if (!grid.grain_volume.empty()) m += static_cast<double>(grid.grain_sums[0][own + l].weight) * scale.cell;
            mass += m, along += m * static_cast<double>(l);
          }
          if (mass == 0) continue;
          sum.moment += low_face(world, rows[n].first, 0) * mass;
          sum.moment.z += along * world.dx;
        }
      },
      [](FaceSums& all, const FaceSums& from) { all.energy.add(from.energy), all.moment += from.moment; });
}

template <class R>
double excess_volume(const MacGrid<R>& grid, std::span<const CellRows::Row> rows) {
  return parallel_reduce(rows.size(), 0.0, [&](double& sum, std::size_t n) {
    const RowPlaces at(rows[n]);
    const R* const d = grid.depth.data();
    for (std::size_t l = 0; l < row_cells; ++l) {
      R least = d[at.own + l];
      for (std::size_t a = 0; a < 3; ++a) least = std::min({least, d[at.low[a] + l], d[at.high[a] + l]});
      if (!(least > R(0))) continue;
      const double held = static_cast<double>(grid.density[at.own + l]);
      const double solid = grid.solid_volume.empty() ? 0 : static_cast<double>(grid.solid_volume[at.own + l]);
      sum += (1 - held) * (1 - solid / held);
    }
  });
}

template <class R>
double crowding(const MacGrid<R>& grid, std::span<const CellRows::Row> rows) {
  struct Sum {
    double excess = 0, all = 0;
  };
  const Sum sum = parallel_reduce(
      rows.size(), Sum{},
      [&](Sum& to, std::size_t n) {
        const std::size_t own = RowPlaces(rows[n]).own;
        for (std::size_t c = own; c < own + row_cells; ++c) {
          if (!(grid.depth[c] > R(0))) continue;
          const double held = static_cast<double>(grid.density[c]);
          to.all += held, to.excess += std::max(held - 1.5, 0.0);
        }
      },
      [](Sum& all, const Sum& from) { all.excess += from.excess, all.all += from.all; });
  return sum.all > 0 ? sum.excess / sum.all : 0;
}

template <class R>
double kinetic_of(const World<R>& world) {
  double sum = 0;
  for (const ParticleSet<R>& set : world.sets) {
    if (!is_projected(set)) continue;
    sum += parallel_reduce(set.size(), 0.0, [&](double& to, std::size_t p) {
      Mat3d c;
      for (std::size_t n = 0; n < 9; ++n)
        c(static_cast<int>(n / 3), static_cast<int>(n % 3)) = static_cast<double>(set.gradient[n][p]);
      to += kinetic_energy(
          set, world.dx,
          static_cast<Vec3d>(Vec3<R>{set.own_velocity[0][p], set.own_velocity[1][p], set.own_velocity[2][p]}), c);
    });
  }
  return sum;
}

#define DM_INSTANTIATE(R)                                                                                \
  template void add_contact(const World<R>&, const MacGrid<R>&, const CutCells<R>&, const Viscosity<R>&, \
                            const StepScale&, GridStats&);                                               \
  template FaceSums face_sums(const World<R>&, MacGrid<R>&, const StepScale&);                           \
  template double excess_volume(const MacGrid<R>&, std::span<const CellRows::Row>);                      \
  template double crowding(const MacGrid<R>&, std::span<const CellRows::Row>);                           \
  template double kinetic_of(const World<R>&);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
