#include "dreampm/solver/projection/body_pressure.h"

#include <algorithm>

namespace dreampm {
namespace {

constexpr std::uint32_t no_body = ~std::uint32_t{0};

/// Blocks whose cells one thread collects.
constexpr std::size_t blocks_at_once = 16;

}  // namespace

template <class R>
void BodyPressure<R>::begin(const World<R>& world, double density) {
  bodies_.clear(), cells_.clear();
  body_of_.assign(world.colliders.size(), no_body);
  const double cell_mass = density * world.dx * world.dx * world.dx;
  for (const RigidBody& body : world.rigid) {
    const Collider& collider = world.colliders[body.collider];
    body_of_[body.collider] = static_cast<std::uint32_t>(bodies_.size());
    Body& b = bodies_.emplace_back();
    b.collider = body.collider;
    b.response = response_of(body, collider);
    for (Six& row : b.response)
      for (double& r : row) r *= cell_mass;
  }
}

template <class R>
Six BodyPressure<R>::column(const World<R>& world, std::uint32_t body, const typename CutCells<R>::ClosedFace& face) {
  const Collider& collider = world.colliders[bodies_[body].collider];
  Six along = along_axis(face.axis, arm_to(world, collider, face.cell, face.middle));
  for (double& v : along) v *= face.closed;
  return along;
}

template <class R>
void BodyPressure<R>::find_cells(const World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut) {
  cells_.clear();
  if (!any()) return;
  const std::vector<Vec3i>& blocks = world.grid.blocks.all();
  pieces_.resize((blocks.size() + blocks_at_once - 1) / blocks_at_once);
  parallel_for(pieces_.size(), 1, [&](std::size_t piece) {
    std::vector<Cell>& found = pieces_[piece];
    found.clear();
    for (std::size_t b = piece * blocks_at_once; b < std::min(blocks.size(), (piece + 1) * blocks_at_once); ++b)
      cut.for_closed(grid, blocks[b], [&](const typename CutCells<R>::ClosedFace& face) {
        const std::uint32_t body = body_of_[face.owner];
        if (body == no_body) return;
        Vec3i below = face.cell;
        below[face.axis] -= 1;
        const std::size_t low = grid.cells.place_of(below);
        const bool pushed = grid.depth[low] > R(0), pulled = grid.depth[face.place] > R(0);
        if (!pushed && !pulled) return;
        // The liquid below a face pushes up, that above it down.
        Six push = column(world, body, face);
        if (pushed) found.push_back({static_cast<std::uint32_t>(low), body, push});
        for (double& p : push) p = -p;
        if (pulled) found.push_back({static_cast<std::uint32_t>(face.place), body, push});
      });
  });
  for (const std::vector<Cell>& piece : pieces_) cells_.insert(cells_.end(), piece.begin(), piece.end());
}

template <class R>
void BodyPressure<R>::sum_columns(const LargeVector<R>& x) {
  for (Body& b : bodies_) b.sum = {};
  for (const Cell& c : cells_) {
    const auto value = static_cast<double>(x[c.place]);
    for (std::size_t n = 0; n < 6; ++n) bodies_[c.body].sum[n] += c.column[n] * value;
  }
  for (Body& b : bodies_) b.gain = b.response * b.sum;
}

template <class R>
double BodyPressure<R>::add(const LargeVector<R>& x, R scale, LargeVector<R>& y) {
  sum_columns(x);
  double product = 0;
  for (const Body& b : bodies_) product += dot(b.sum, b.gain);
  for (const Cell& c : cells_) y[c.place] += scale * static_cast<R>(dot(c.column, bodies_[c.body].gain));
  return product;
}

template <class R>
void BodyPressure<R>::gain(World<R>& world, double times) {
  for (Body& b : bodies_) {
    for (double& g : b.gain) g *= times;
    dreampm::add(world.colliders[b.collider].twist, b.gain);
  }
}

template <class R>
void BodyPressure<R>::move_bodies(World<R>& world, const LargeVector<R>& impulse, double times) {
  sum_columns(impulse);
  gain(world, times);
}

template <class R>
void BodyPressure<R>::press_on_surfaces(World<R>& world, const MacGrid<R>& grid, const CutCells<R>& cut,
                                        const Vec3d& gained) {
  for (Body& b : bodies_) b.sum = {};
  const auto slope = [&](std::size_t cell) { return pressure_slope(static_cast<double>(grid.depth[cell]), gained); };
  for (const Vec3i& block : world.grid.blocks.all()) {
    cut.for_closed(grid, block, [&](const typename CutCells<R>::ClosedFace& face) {
      const std::uint32_t body = body_of_[face.owner];
      if (body == no_body) return;
      Vec3i below = face.cell;
      below[face.axis] -= 1;
      const double push =
          dot(slope(grid.cells.place_of(below)), face.way(false)) - dot(slope(face.place), face.way(true));
      if (push == 0) return;
      const Six along = column(world, body, face);
      for (std::size_t n = 0; n < 6; ++n) bodies_[body].sum[n] += push * along[n];
    });
    cut.for_filled(grid, block, [&](const typename CutCells<R>::FilledCell& cell) {
      const std::uint32_t body = body_of_[cell.owner];
      const Vec3d push = slope(cell.place) * -cell.filled;
      if (body == no_body || push == Vec3d{}) return;
      const Vec3d turn = cross(arm_to(world, world.colliders[bodies_[body].collider], cell.cell, cell.middle), push);
      for (int a = 0; a < 3; ++a) {
        bodies_[body].sum[static_cast<std::size_t>(a)] += push[a];
        bodies_[body].sum[static_cast<std::size_t>(a) + 3] += turn[a];
      }
    });
  }
  for (Body& b : bodies_) b.gain = b.response * b.sum;
  gain(world, 1);
}

template class BodyPressure<float>;
template class BodyPressure<double>;

}  // namespace dreampm
