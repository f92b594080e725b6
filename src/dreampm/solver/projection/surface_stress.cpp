#include "dreampm/solver/projection/surface_stress.h"

#include <algorithm>

#include "dreampm/solver/projection/fill_field.h"

namespace dreampm {

template <class R>
void SurfaceStress<R>::begin(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut) {
  const std::vector<bool>& holds = grid.holding.colliders;
  stiff_ = holds;
  stiff_.flip();
  for (const RigidBody& body : world.rigid) stiff_[body.collider] = true;
  if (std::find(stiff_.begin(), stiff_.end(), true) == stiff_.end()) {
    cell_.clear();
    return;
  }
  const std::size_t size = grid.cells.size();
  fill_field(cell_, size, R(1));
  for (Faces* parts : {&face_, &edge_})
    for (Field& part : *parts) fill_field(part, size, R(1));
  for (Field* f : {&kappa_, &beta_, &pull_, &swell_}) fill_field(*f, size, R(0));
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  parallel_for(blocks.size(), 16, [&](std::size_t b) {
    cut.for_parts(grid, blocks[b], [&](const typename CutCells<R>::FilledParts& parts) {
      if (parts.owner != grid.no_owner && !holds[parts.owner]) cell_[parts.place] = 1 - parts.cell;
      for (std::size_t a = 0; a < 3; ++a)
        face_[a][parts.place] = 1 - parts.face[a], edge_[a][parts.place] = 1 - parts.edge[a];
    });
  });
  grid.wrap(cell_);
  // Cells that others fill are left to those.
  for_all_rows(grid.cells.rows(), [&](const CellRows::Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      for (std::size_t l = 0; l < row_cells; ++l) {
        const bool own = cell_[at.own + l] < R(1);
        if (!own && !(cell_[at.low[a] + l] < R(1))) face_[a][at.own + l] = 1;
        if (!own && !(cell_[at.low[b] + l] < R(1)) && !(cell_[at.low[c] + l] < R(1))) edge_[a][at.own + l] = 1;
      }
    }
  });
  for (Faces* parts : {&face_, &edge_})
    for (Field& part : *parts) grid.wrap(part);
}

template <class R>
void SurfaceStress<R>::find_stress(const MacGrid<R>& grid, const Faces& u, bool moving) {
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  const bool solids = moving && !grid.solid[0].empty();
  parallel_for(cut_rows_.size(), 64, [&](std::size_t n) {
    const RowPlaces at(rows[cut_rows_[n]]);
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      R flow = 0, divergence = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t high = at.high[a] + l;
        const R low_open = grid.open[a][c], high_open = grid.open[a][high];
        flow += high_open * u[a][high] - low_open * u[a][c];
        if (solids) flow += (1 - high_open) * grid.solid[a][high] - (1 - low_open) * grid.solid[a][c];
        divergence += u[a][high] - u[a][c];
      }
      pull_[c] = kappa_[c] * flow, swell_[c] = beta_[c] * divergence;
    }
  });
}

template <class R>
void SurfaceStress<R>::add_force(const MacGrid<R>& grid, Faces& f) const {
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  parallel_for(rows_beside_.size(), 64, [&](std::size_t n) {
    const RowPlaces at(rows[rows_beside_[n]]);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t c = at.own + l, below = at.low[a] + l;
        f[a][c] += grid.open[a][c] * (pull_[c] - pull_[below]) + (swell_[c] - swell_[below]);
      }
  });
}

template class SurfaceStress<float>;
template class SurfaceStress<double>;

}  // namespace dreampm
