#include "dreampm/solver/projection/body_pressure.h"

#include <algorithm>

#include "dreampm/base/narrow.h"

namespace dreampm {
namespace {

constexpr std::uint32_t no_body = ~std::uint32_t{0};

/// Rows whose cells one thread collects.
constexpr std::size_t rows_at_once = 256;

/// The velocity along an axis at `arm` [m] from the center, for each component of a body's twist.
std::array<double, 6> along(int axis, const Vec3d& arm) {
  Vec3d unit{};
  unit[axis] = 1;
  const Vec3d turned = cross(arm, unit);
  return {unit.x, unit.y, unit.z, turned.x, turned.y, turned.z};
}

/// What a twist changes by for an impulse and an angular impulse; locked components by nothing.
std::array<std::array<double, 6>, 6> response_of(const RigidBody& body, const Collider& collider) {
  std::array<std::array<double, 6>, 6> out{};
  for (std::size_t a = 0; a < 3; ++a)
    if (!body.locked[a]) out[a][a] = 1 / body.mass;
  // Of what is locked the inertia is endless.
  Mat3d inertia = inertia_now(body, collider);
  for (int a = 0; a < 3; ++a)
    if (body.locked[static_cast<std::size_t>(a) + 3])
      for (int b = 0; b < 3; ++b) inertia(a, b) = inertia(b, a) = a == b ? 1 : 0;
  const Mat3d turns = inverse(inertia);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      if (!body.locked[a + 3] && !body.locked[b + 3])
        out[a + 3][b + 3] = turns(static_cast<int>(a), static_cast<int>(b));
  return out;
}

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
    b.collider = narrow<std::uint16_t>(body.collider, "colliders");
    b.center = collider.twist.center;
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
            const Vec3d middle = world.node_position(cell) + face_middle(axis, high) * world.dx;
            const Six column = along(axis, middle - bodies_[body].center);
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
  for (Body& b : bodies_)
    for (std::size_t n = 0; n < 6; ++n) {
      b.gain[n] = 0;
      for (std::size_t m = 0; m < 6; ++m) b.gain[n] += b.response[n][m] * b.sum[m];
    }
}

template <class R>
double BodyPressure<R>::add(const LargeVector<R>& x, R scale, LargeVector<R>& y) {
  sum_columns(x);
  double product = 0;
  for (const Body& b : bodies_)
    for (std::size_t n = 0; n < 6; ++n) product += b.sum[n] * b.gain[n];
  for (const Cell& c : cells_) {
    double given = 0;
    for (std::size_t n = 0; n < 6; ++n) given += c.column[n] * bodies_[c.body].gain[n];
    y[c.place] += scale * static_cast<R>(given);
  }
  return product;
}

template <class R>
void BodyPressure<R>::move_bodies(World<R>& world, const LargeVector<R>& impulse) {
  sum_columns(impulse);
  for (const Body& b : bodies_) {
    Twist& twist = world.colliders[b.collider].twist;
    twist.velocity += Vec3d{b.gain[0], b.gain[1], b.gain[2]};
    twist.spin += Vec3d{b.gain[3], b.gain[4], b.gain[5]};
  }
}

template class BodyPressure<float>;
template class BodyPressure<double>;

}  // namespace dreampm
