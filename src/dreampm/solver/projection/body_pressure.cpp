#include "dreampm/solver/projection/body_pressure.h"

#include <algorithm>

namespace dreampm {
namespace {

constexpr std::uint32_t no_body = ~std::uint32_t{0};

/// Rows whose cells one thread collects.
constexpr std::size_t rows_at_once = 256;

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
void BodyPressure<R>::find_cells(const World<R>& world, const MacGrid<R>& grid) {
  cells_.clear();
  if (!any()) return;
  const std::span<const CellRows::Row> rows = grid.cells.rows();
  pieces_.resize((rows.size() + rows_at_once - 1) / rows_at_once);
  parallel_for(pieces_.size(), 1, [&](std::size_t piece) {
    std::vector<Cell>& found = pieces_[piece];
    found.clear();
    for (std::size_t n = piece * rows_at_once; n < std::min(rows.size(), (piece + 1) * rows_at_once); ++n) {
      const RowPlaces at(rows[n]);
      for (std::size_t l = 0; l < row_cells; ++l) {
        if (!(grid.depth[at.own + l] > R(0))) continue;
        const std::size_t first = found.size();
        const Vec3i cell = rows[n].first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
        for (std::size_t a = 0; a < 3; ++a)
          for (const bool high : {false, true}) {
            const std::size_t face = (high ? at.high[a] : at.own) + l;
            const R closed = 1 - grid.open[a][face];
            if (!(closed > R(0)) || grid.owner[a][face] == grid.no_owner) continue;
            const std::uint32_t body = body_of_[grid.owner[a][face]];
            if (body == no_body) continue;
            auto to = std::find_if(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
                                   [&](const Cell& c) { return c.body == body; });
            if (to == found.end()) {
              found.push_back({static_cast<std::uint32_t>(at.own + l), body, {}});
              to = found.end() - 1;
            }
            const auto axis = static_cast<int>(a);
            const Collider& collider = world.colliders[bodies_[body].collider];
            const Six column = along_axis(axis, arm_to_face(world, collider, cell, axis, high));
            // The liquid of a cell pushes its high face up, and its low face down.
            const double part = static_cast<double>(high ? closed : -closed);
            for (std::size_t c = 0; c < 6; ++c) to->column[c] += part * column[c];
          }
      }
    }
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
void BodyPressure<R>::move_bodies(World<R>& world, const LargeVector<R>& impulse, double times) {
  sum_columns(impulse);
  for (Body& b : bodies_) {
    for (double& g : b.gain) g *= times;
    dreampm::add(world.colliders[b.collider].twist, b.gain);
  }
}

template class BodyPressure<float>;
template class BodyPressure<double>;

}  // namespace dreampm
