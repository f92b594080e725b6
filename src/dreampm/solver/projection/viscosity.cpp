#include "dreampm/solver/projection/viscosity.h"

#include <algorithm>
#include <cmath>

#include "dreampm/solver/projection/fill_field.h"

namespace dreampm {
namespace {

using Row = CellRows::Row;

/// Less than this part of a cell a face does not hold: it would take on any speed.
constexpr double least_face_mass = 0.01;

/// The least distance outside of a collider between two faces on either side of its surface
/// [cells].
constexpr double least_way = 0.1;

/// The tolerance, over the first residual, and the most iterations.
constexpr double viscous_tolerance = 1e-4;
constexpr int most_viscous_iterations = 400;

/// Rows over which sums are one piece.
constexpr std::size_t rows_of_a_sum = 64;

/// The other two axes.
constexpr std::size_t next(std::size_t a) { return (a + 1) % 3; }
constexpr std::size_t after(std::size_t a) { return (a + 2) % 3; }

/// A sum over all cells of a grid of what body(place) gives, in a fixed order.
template <class Body>
double sum_over_cells(std::span<const Row> rows, std::vector<double>& parts, const Body& body) {
  const std::size_t pieces = (rows.size() + rows_of_a_sum - 1) / rows_of_a_sum;
  resize_for_overwrite(parts, pieces);
  parallel_for(pieces, 1, [&](std::size_t piece) {
    double sum = 0;
    for (std::size_t n = piece * rows_of_a_sum; n < std::min(rows.size(), (piece + 1) * rows_of_a_sum); ++n) {
      const std::size_t first = std::size_t{rows[n].number} * row_cells;
      for (std::size_t c = first; c < first + row_cells; ++c) sum += body(c);
    }
    parts[piece] = sum;
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

/// The part of a cell that liquid fills: all of it where liquid is on all sides, however many
/// particles lie there.
template <class R>
R liquid_in(const MacGrid<R>& grid, const RowPlaces& at, std::size_t l) {
  const std::size_t c = at.own + l;
  if (!grid.solid_volume.empty()) return std::max(grid.density[c] - grid.solid_volume[c], R(0));
  return grid.is_deep(at, l) ? R(1) : grid.density[c];
}

}  // namespace

template <class R>
R Viscosity<R>::stiffness(const MacGrid<R>& grid, std::size_t a, const RowPlaces& at, std::size_t l) const {
  const std::size_t f = at.own + l;
  R sum = normal_[a][f] + normal_[a][at.low[a] + l];
  for (const std::size_t b : {next(a), after(a)}) {
    const LargeVector<R>& edges = shear_[3 - a - b];
    sum += edges[f] + edges[at.high[b] + l];
  }
  if (surfaces_.any()) sum += surfaces_.stiffness(grid, a, at, l);
  return sum;
}

template <class R>
void Viscosity<R>::weigh(const World<R>& world, MacGrid<R>& grid, double diffusion) {
  const std::size_t size = grid.cells.size();
  for (Faces* f :
       {&mass_, &inverse_, &velocity_, &residual_, &direction_, &product_, &normal_, &shear_, &pull_, &twist_})
    for (LargeVector<R>& v : *f) fill_field(v, size, R(0));
  fill_field(liquid_, size, R(0));
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t l = 0; l < row_cells; ++l) liquid_[at.own + l] = liquid_in(grid, at, l);
  });
  grid.wrap(liquid_);
  const R s = static_cast<R>(diffusion);
  const bool cut = surfaces_.any();
  const auto left_of_cell = [&](std::size_t c) { return cut ? surfaces_.in_cell(c) : R(1); };
  // Faces within a collider along which the liquid slips are those of the flow before it, where one
  // of their cells is not all within.
  const auto goes_on = [&](const Row& row, std::size_t a, const RowPlaces& at, std::size_t l) {
    const std::size_t f = at.own + l;
    if (!cut || !(surfaces_.closed(grid, a, f) > R(0))) return false;
    const Vec3i cell = row.first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
    for (int t = 0; t < 3; ++t)
      if (!grid.within(t, cell[t]) || (t == static_cast<int>(a) && cell[t] == grid.low[t])) return false;
    const auto holds = [&](std::size_t c) { return surfaces_.in_cell(c) > R(0) && liquid_[c] > R(0); };
    return holds(f) || holds(at.low[a] + l);
  };
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l, below = at.low[a] + l;
        const bool closed = !(grid.open[a][f] > R(0)), inner = closed && goes_on(row, a, at, l);
        if ((closed && !inner) || grid.is_in_holder(a, f)) {
          velocity_[a][f] = grid.solid[a].empty() ? R(0) : grid.solid[a][f];
          // Liquid that flows through its open part sticks.
          if (!closed) grid.free[a][f] = velocity_[a][f];
        } else if (is_known(grid.free[a][f]) || inner) {
          R mass = (liquid_[f] + liquid_[below]) / 2;
          if (cut && surfaces_.at_face(a, f) < R(1)) {
            const R own = surfaces_.in_cell(f), other = surfaces_.in_cell(below);
            mass = surfaces_.at_face(a, f) * (own * liquid_[f] + other * liquid_[below]) /
                   std::max(own + other, static_cast<R>(least_face_mass));
          }
          mass_[a][f] = std::max(mass, static_cast<R>(least_face_mass));
          if (!grid.solid_sums[a].empty()) mass_[a][f] += grid.solid_sums[a][f].weight;
          velocity_[a][f] = is_known(grid.free[a][f]) ? grid.free[a][f]
                            : grid.solid[a].empty()   ? R(0)
                                                      : grid.solid[a][f];
        }
      }
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(mass_[a]), grid.wrap(velocity_[a]);
  // Between the middle of a face in a collider and that of one outside: what is not in the
  // collider.
  const auto way = [&](std::size_t a, std::size_t one, std::size_t other) {
    if (grid.is_in_holder(a, one) == grid.is_in_holder(a, other)) return R(1);
    const R d = grid.gap[a][one], e = grid.gap[a][other];
    return std::max(std::max(d, e) / std::abs(d - e), static_cast<R>(least_way));
  };
  const auto given = [&](std::size_t a, std::size_t f) {
    return !(mass_[a][f] > R(0)) && (!(grid.open[a][f] > R(0)) || grid.is_in_holder(a, f));
  };
  const auto counts = [&](std::size_t a, std::size_t f) { return mass_[a][f] > R(0) || given(a, f); };
  for_all_rows(grid.cells.rows(), [&](const Row& row, const RowPlaces& at) {
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = at.own + l;
      const Vec3i cell = row.first + Vec3i{0, 0, static_cast<std::int32_t>(l)};
      const bool within = grid.within(0, cell.x) && grid.within(1, cell.y) && grid.within(2, cell.z);
      bool all = within;
      for (std::size_t a = 0; a < 3; ++a) all = all && counts(a, c) && counts(a, at.high[a] + l);
      for (std::size_t a = 0; a < 3 && all; ++a)
        normal_[a][c] = 2 * s * left_of_cell(c) * std::min(liquid_[c], R(1)) / way(a, c, at.high[a] + l);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // The edge along `axis`: faces of a beside one another along b, and the other way round.
        const std::size_t a = next(axis), b = after(axis);
        if (!grid.within(static_cast<int>(axis), cell[static_cast<int>(axis)])) continue;
        const std::size_t faces[4] = {c, at.low[b] + l, c, at.low[a] + l};
        const std::size_t along[4] = {a, a, b, b};
        const int walls[2] = {grid.wall_at(static_cast<int>(a), cell[static_cast<int>(a)]),
                              grid.wall_at(static_cast<int>(b), cell[static_cast<int>(b)])};
        if (walls[0] >= 0 && walls[1] >= 0) continue;
        R held = 0, left = 0;
        bool whole = true;
        for (int n = 0; n < 4; ++n) {
          R mass = mass_[along[n]][faces[n]];
          if (!grid.solid_sums[0].empty()) mass -= grid.solid_sums[along[n]][faces[n]].weight;
          held += std::clamp(mass, R(0), R(1)) / 4;
          if (cut) left += surfaces_.at_face(along[n], faces[n]) / 4;
          whole = whole && counts(along[n], faces[n]);
        }
        // Faces are a cell wide, and know less well than the edge what is left of it.
        if (cut && surfaces_.at_edge(axis, c) != left)
          held *= surfaces_.at_edge(axis, c) / std::max(left, static_cast<R>(least_face_mass));
        if (const int wall = std::max(walls[0], walls[1]); wall >= 0) {
          // The faces before the wall are half a cell from it: over half of a cell, twice the
          // slope.
          if (grid.holding.walls[static_cast<std::size_t>(wall)]) shear_[axis][c] = 8 * s * held;
          continue;
        }
        if (!whole) continue;
        bool stands_alone = false;
        R open = 0;
        for (int n = 0; n < 4; ++n) {
          if (!given(along[n], faces[n]))
            open += R(1);
          else
            stands_alone = stands_alone || !grid.is_held(along[n], faces[n]);
        }
        if (!stands_alone && open > R(0))
          shear_[axis][c] = s * held * 4 / (open * std::min(way(a, faces[0], faces[1]), way(b, faces[2], faces[3])));
      }
    }
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(normal_[a]), grid.wrap(shear_[a]);
  if (cut) surfaces_.find_stiffness(world, grid, s, counts);
  // The diagonal.
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l;
        if (!(mass_[a][f] > R(0))) continue;
        inverse_[a][f] = 1 / (mass_[a][f] + stiffness(grid, a, at, l));
      }
  });
}

template <class R>
void Viscosity<R>::force(const MacGrid<R>& grid, const Faces& u, const std::vector<Six>& bodies, bool moving, Faces& f,
                         std::vector<Six>& on_bodies) {
  const bool cut = surfaces_.any();
  if (cut) {
    surfaces_.find_stress(grid, u, moving);
    bodies_.add_flow(bodies, surfaces_);
    surfaces_.end_stress(grid);
  }
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = next(a), c = after(a);
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t p = at.own + l;
        pull_[a][p] = normal_[a][p] * (u[a][at.high[a] + l] - u[a][p]);
        twist_[a][p] = shear_[a][p] * ((u[b][p] - u[b][at.low[c] + l]) + (u[c][p] - u[c][at.low[b] + l]));
      }
    }
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(pull_[a]), grid.wrap(twist_[a]);
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = next(a), c = after(a);
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t p = at.own + l;
        const R sum = (pull_[a][p] - pull_[a][at.low[a] + l]) + (twist_[c][at.high[b] + l] - twist_[c][p]) +
                      (twist_[b][at.high[c] + l] - twist_[b][p]);
        f[a][p] = sum;
      }
    }
  });
  if (cut) surfaces_.add_force(grid, f);
  bodies_.gather(f, surfaces_, on_bodies);
}

template <class R>
ViscousSolve Viscosity<R>::solve(World<R>& world, MacGrid<R>& grid, const CutCells<R>& cut,
                                 const BodyPressure<R>& bodies, double diffusion, double density) {
  ViscousSolve out;
  acts_ = true;
  surfaces_.begin(world, grid, cut);
  weigh(world, grid, diffusion);
  bodies_.begin(world, grid, density,
                [&](std::size_t a, const RowPlaces& at, std::size_t l) { return stiffness(grid, a, at, l); });
  bodies_.add_cells(bodies, surfaces_);
  const std::span<const Row> rows = grid.cells.rows();
  const auto each = [&](const auto& body) {
    for_all_rows(rows, [&](const Row&, const RowPlaces& at) {
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t c = at.own; c < at.own + row_cells; ++c)
          if (mass_[a][c] > R(0)) body(a, c);
    });
  };
  // The inner product over faces and bodies.
  const auto product = [&](const Faces& x, const Faces& y, const std::vector<Six>& bx, const std::vector<Six>& by) {
    double sum = sum_over_cells(rows, parts_, [&](std::size_t c) {
      double at = 0;
      for (std::size_t a = 0; a < 3; ++a)
        at += mass_[a][c] > R(0) ? static_cast<double>(x[a][c]) * static_cast<double>(y[a][c]) : 0;
      return at;
    });
    for (std::size_t b = 0; b < bodies_.size(); ++b) sum += dot(bx[b], by[b]);
    return sum;
  };
  body_velocity_.assign(bodies_.size(), {}), body_direction_.assign(bodies_.size(), {});
  // From the velocities before: what is missing is the force of their stresses.
  force(grid, velocity_, body_velocity_, true, residual_, body_residual_);
  const double first = product(residual_, residual_, body_residual_, body_residual_);
  double square = first, rho = 0;
  while (square > viscous_tolerance * viscous_tolerance * first && out.iterations < most_viscous_iterations) {
    const double before = rho;
    each([&](std::size_t a, std::size_t c) { product_[a][c] = inverse_[a][c] * residual_[a][c]; });
    bodies_.precondition(body_residual_, body_steps_);
    rho = product(residual_, product_, body_residual_, body_steps_);
    const double beta = out.iterations > 0 ? rho / before : 0;
    each([&](std::size_t a, std::size_t c) {
      direction_[a][c] = product_[a][c] + static_cast<R>(beta) * direction_[a][c];
    });
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t n = 0; n < 6; ++n) body_direction_[b][n] = body_steps_[b][n] + beta * body_direction_[b][n];
    bodies_.scatter(body_direction_, direction_);
    for (auto& d : direction_) grid.wrap(d);
    force(grid, direction_, body_direction_, false, product_, body_product_);
    each([&](std::size_t a, std::size_t c) { product_[a][c] = mass_[a][c] * direction_[a][c] - product_[a][c]; });
    bodies_.weigh(body_direction_, body_steps_);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t n = 0; n < 6; ++n) body_product_[b][n] = body_steps_[b][n] - body_product_[b][n];
    const double curvature = product(direction_, product_, body_direction_, body_product_);
    if (!(curvature > 0)) break;
    const double alpha = rho / curvature;
    each([&](std::size_t a, std::size_t c) {
      velocity_[a][c] += static_cast<R>(alpha) * direction_[a][c];
      residual_[a][c] -= static_cast<R>(alpha) * product_[a][c];
    });
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (std::size_t n = 0; n < 6; ++n) {
        body_velocity_[b][n] += alpha * body_direction_[b][n];
        body_residual_[b][n] -= alpha * body_product_[b][n];
      }
    square = product(residual_, residual_, body_residual_, body_residual_);
    ++out.iterations;
  }
  out.residual = first > 0 ? std::sqrt(square / first) : 0;
  out.heat = sum_over_cells(rows, parts_, [&](std::size_t c) {
    double sum = 0;
    for (std::size_t a = 0; a < 3; ++a)
      if (const R was = grid.free[a][c], is = velocity_[a][c]; mass_[a][c] > R(0))
        sum += static_cast<double>(mass_[a][c] * (was - is) * (was + is) / 2);
    return sum;
  });
  bodies_.scatter_more(body_velocity_, velocity_, grid);
  for (auto& v : velocity_) grid.wrap(v);
  force(grid, velocity_, body_velocity_, true, product_, body_product_);
  each([&](std::size_t a, std::size_t c) {
    if (grid.open[a][c] > R(0)) grid.free[a][c] = velocity_[a][c];
  });
  for (auto& f : grid.free) grid.wrap(f);
  bodies_.move(world, body_velocity_);
  return out;
}

template class Viscosity<float>;
template class Viscosity<double>;

}  // namespace dreampm
