#include "dreampm/solver/projection/forces.h"

#include <cmath>

#include "dreampm/physics/projection/skin.h"
#include "dreampm/solver/projection/wall_images.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {
namespace {

/// Returns the box in which fields act [m]; everywhere if one has no bounds.
template <class R>
Box3d reach_of(const World<R>& world) {
  constexpr double far = 1e30;
  Box3d all{{far, far, far}, {-far, -far, -far}};
  for (const ForceField& f : world.fields) {
    Box3d box = f.box.value_or(Box3d{{-far, -far, -far}, {far, far, far}});
    std::visit(
        [&](const auto& field) {
          if constexpr (requires { field.bounds(); })
            box = {max(box.min, field.bounds().min), min(box.max, field.bounds().max)};
        },
        f.field);
    all = {min(all.min, box.min), max(all.max, box.max)};
  }
  return all;
}

/// The whole velocity at face `at` of axis `a`, whose neighbors in its own cell and in the one
/// below give the other components.
template <class R>
Vec3<R> velocity_at(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l, std::size_t a) {
  Vec3<R> v;
  v[static_cast<int>(a)] = grid.free[a][at.own + l];
  for (std::size_t t = 0; t < 3; ++t) {
    if (t == a) continue;
    R sum = 0;
    int count = 0;
    for (const std::size_t face : {at.own + l, at.high[t] + l, at.low[a] + l})
      if (const R u = grid.free[t][face]; is_known(u)) sum += u, ++count;
    if (count > 0) v[static_cast<int>(t)] = sum / static_cast<R>(count);
  }
  return v;
}

}  // namespace

template <class R>
ImpulseSum apply_fields(const World<R>& world, MacGrid<R>& grid, double kick) {
  const FieldSteps<R> fields(world, kick);
  const ParticleSet<R>* const liquid = liquid_of(world);
  if (!fields.any() || !liquid) return {};
  const double mass = liquid->mass;  // of a particle: the weights of faces count them
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  const Box3d reach = reach_of(world);
  const auto acts = [&](const CellRows::Row& row) {
    const Vec3d first = world.node_position(row.first), size = Vec3d{1, 1, row_cells} * world.dx;
    return !Box3d{max(first, reach.min), min(first + size, reach.max)}.empty();
  };
  // Components are read where others are made, so that they wait in `moving`, which is free yet.
  const ImpulseSum given = parallel_reduce(rows.size(), ImpulseSum{}, [&](ImpulseSum& sum, std::size_t n) {
    if (!acts(rows[n])) return;
    const RowPlaces at(rows[n]);
    const auto [first, last] = grid.lanes_within(rows[n]);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t c = at.own + l;
        const R before = grid.moving[a][c] = grid.free[a][c];
        if (!is_known(before)) continue;
        const auto axis = static_cast<int>(a);
        Vec3d place = world.node_position(rows[n].first + Vec3i{0, 0, static_cast<std::int32_t>(l)});
        for (int t = 0; t < 3; ++t) place[t] += t == axis ? 0 : 0.5 * world.dx;
        const R after = fields.apply(velocity_at(grid, at, l, a), place)[axis];
        grid.moving[a][c] = after;
        Vec3d was, is;
        was[axis] = static_cast<double>(before), is[axis] = static_cast<double>(after);
        // Beyond the ends of a periodic axis lie copies.
        if (l >= static_cast<std::size_t>(first) && l < static_cast<std::size_t>(last))
          sum.add(place, mass * static_cast<double>(grid.sums[a][c].weight), was, is, is);
      }
  });
  for_all_rows(rows, [&](const CellRows::Row& row, const RowPlaces& at) {
    if (!acts(row)) return;
    for (std::size_t a = 0; a < 3; ++a)
      std::copy_n(grid.moving[a].data() + at.own, row_cells, grid.free[a].data() + at.own);
  });
  for (auto& free : grid.free) grid.wrap(free);
  return given;
}

template <class R>
void damp(MacGrid<R>& grid, double part, const Vec3d& gained) {
  for (int axis = 0; axis < 3; ++axis) {
    auto& field = grid.free[static_cast<std::size_t>(axis)];
    const R given = static_cast<R>(gained[axis]);
    parallel_for(field.size(), 1 << 14, [&](std::size_t f) {
      if (is_known(field[f])) field[f] = given + (field[f] - given) * static_cast<R>(part);
    });
  }
}

template <class R>
void slow_along_walls(MacGrid<R>& grid, const std::array<bool, 6>& walls, const SkinFriction& skin) {
  const R viscosity = static_cast<R>(skin.viscosity), dx = static_cast<R>(skin.dx),
          kick_per_dx = static_cast<R>(skin.kick / skin.dx);
  for (int axis = 0; axis < 3; ++axis) {
    const auto b = static_cast<std::size_t>((axis + 1) % 3), c = static_cast<std::size_t>((axis + 2) % 3);
    for_images(grid, axis, [&](std::size_t, std::size_t before, int count, std::size_t wall) {
      if (!walls[wall]) return;
      for (std::size_t at = before; at < before + static_cast<std::size_t>(count); ++at) {
        const R vb = grid.free[b][at], vc = grid.free[c][at];
        const R known_b = is_known(vb) ? vb : R(0), known_c = is_known(vc) ? vc : R(0);
        const R speed = std::sqrt(known_b * known_b + known_c * known_c);
        if (!(speed > R(0))) continue;
        const R left = skin_slows(speed, viscosity, dx, kick_per_dx);
        if (is_known(vb)) grid.free[b][at] = vb * left;
        if (is_known(vc)) grid.free[c][at] = vc * left;
      }
    });
  }
  for (auto& f : grid.free) grid.wrap(f);
}

template void damp(MacGrid<float>&, double, const Vec3d&);
template void damp(MacGrid<double>&, double, const Vec3d&);
template void slow_along_walls(MacGrid<float>&, const std::array<bool, 6>&, const SkinFriction&);
template void slow_along_walls(MacGrid<double>&, const std::array<bool, 6>&, const SkinFriction&);
template ImpulseSum apply_fields(const World<float>&, MacGrid<float>&, double);
template ImpulseSum apply_fields(const World<double>&, MacGrid<double>&, double);

}  // namespace dreampm
