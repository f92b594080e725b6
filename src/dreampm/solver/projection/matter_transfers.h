// Matter beside the liquid and the staggered grid: what its particles give, and what they take.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "dreampm/solver/projection/block_window.h"
#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/wall_images.h"

namespace dreampm {

/// True if a set is of grains that liquid flows between (solver/projection/grains.h).
template <class R>
bool is_grains(const ParticleSet<R>& set) {
  return set.material == "sand";
}

/// True if a set is of matter that the liquid does not enter: both have one velocity.
template <class R>
bool is_tied(const ParticleSet<R>& set) {
  return !is_projected(set) && !is_grains(set);
}

/// The arrays to which particles give.
template <class R>
struct GivenMatter {
  std::array<LargeVector<FaceSum<R>>, 3>& sums;  ///< of faces, over the mass of a cell of liquid
  std::array<LargeVector<R>, 3>& face_volume;    ///< of faces, over a cell
  LargeVector<R>& cell_volume;                   ///< of cells, over a cell
};

/// A particle's share in a cell: its mass by the density of the liquid [kg/m^3], and the part of
/// its volume that liquid cannot take.
struct MatterShare {
  double density = 1, solid = 1;
};

/// The particles of block `b` of a set.
template <class R>
void give_block(const World<R>& world, const ParticleSet<R>& set, std::size_t b, const CellRows& cells,
                const MatterShare& share, const GivenMatter<R>& to) {
  const Window<0> window(cells, world.particle_blocks[b]);
  const double cell = world.dx * world.dx * world.dx;
  const R dx = static_cast<R>(world.dx), mass = static_cast<R>(set.mass / (share.density * cell)),
          volume = static_cast<R>(share.solid * set.rest_volume / cell);
  for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
    const StaggeredPlace<R> place(Four<R>{set.u[0][p], set.u[1][p], set.u[2][p], 0} + R(0.5));
    for (std::size_t a = 0; a < 3; ++a) {
      const TrilinearCell<R> cell_of_face = place.faces(static_cast<int>(a));
      Four<R> motion;
      motion_along(set, p, a, dx, motion);
      Four<R> given[4];
      given_to_faces(cell_of_face, motion, given);
      for (int n = 0; n < 4; ++n)
        for (int k = 0; k < 2; ++k) {
          const std::size_t at = window.place(cell_of_face.first[0] + (n >> 1), cell_of_face.first[1] + (n & 1),
                                              cell_of_face.first[2] + k);
          to.sums[a][at] += {mass * given[n][2 * k], mass * given[n][2 * k + 1]};
          to.face_volume[a][at] += volume * given[n][2 * k + 1];
        }
    }
    const TrilinearCell<R> center = place.centers();
    const Corners<R> shares = shares_of_centers(center);
    for (int n = 0; n < 8; ++n)
      to.cell_volume[window.place(center.first[0] + (n >> 2), center.first[1] + (n >> 1 & 1),
                                  center.first[2] + (n & 1))] += (n < 4 ? shares.low : shares.high)[n & 3] * volume;
  }
}

/// The velocity that a lasting pressure gives to particles in a step, by set and particle [m/s].
/// Explicit steps spread it over their time, where given at once it would tear them, or throw them
/// up to fall again; and take it out at the end, so that it changes no momentum.
template <class R>
using Pushes = std::vector<std::vector<Vec3<R>>>;

/// Returns the lasting part of a pressure, or of a drag: no more than two successive ones have in
/// common.
template <class R>
R lasting(R now, R other) {
  return now * other > R(0) ? (std::abs(now) < std::abs(other) ? now : other) : R(0);
}

/// Calls take(p, axis, gain) for all particles of a set and axes: what `change`
/// of faces is at the particle, and its slopes [1/cell].
template <class R, class Take>
void for_changes(const World<R>& world, const ParticleSet<R>& set, const CellRows& cells,
                 const std::array<LargeVector<R>, 3>& change, const Take& take) {
  if (set.size() == 0) return;
  parallel_for(world.particle_blocks.size(), 4, [&](std::size_t b) {
    if (set.block_start[b] == set.block_start[b + 1]) return;
    const Window<0> window(cells, world.particle_blocks[b]);
    for (std::size_t p = set.block_start[b]; p < set.block_start[b + 1]; ++p) {
      const StaggeredPlace<R> place(Four<R>{set.u[0][p], set.u[1][p], set.u[2][p], 0} + R(0.5));
      for (std::size_t a = 0; a < 3; ++a) {
        const TrilinearCell<R> cell = place.faces(static_cast<int>(a));
        const auto corner = [&](int i, int n) {
          return change[a][window.place(cell.first[0] + i, cell.first[1] + (n >> 1), cell.first[2] + (n & 1))];
        };
        const Corners<R> corners{{corner(0, 0), corner(0, 1), corner(0, 2), corner(0, 3)},
                                 {corner(1, 0), corner(1, 1), corner(1, 2), corner(1, 3)}};
        Four<R> gain;
        trilinear_slope(cell, corners, gain);
        take(p, a, gain);
      }
    }
  });
}

/// Adds what `gained` of faces is at them to the particles of a set, value and slope; `pushes`
/// become what `push` is there.
template <class R>
void give_changes(const World<R>& world, ParticleSet<R>& set, const CellRows& cells,
                  const std::array<LargeVector<R>, 3>& gained, const std::array<LargeVector<R>, 3>& push,
                  std::vector<Vec3<R>>& pushes) {
  const R per_cell = static_cast<R>(1 / world.dx);
  for_changes(world, set, cells, gained, [&](std::size_t p, std::size_t a, const Four<R>& gain) {
    set.own_velocity[a][p] += gain[0];
    for (std::size_t t = 0; t < 3; ++t) set.gradient[3 * a + t][p] += gain[static_cast<int>(t) + 1] * per_cell;
  });
  pushes.assign(set.size(), Vec3<R>{});
  for_changes(world, set, cells, push,
              [&](std::size_t p, std::size_t a, const Four<R>& gain) { pushes[p][static_cast<int>(a)] = gain[0]; });
}

}  // namespace dreampm
