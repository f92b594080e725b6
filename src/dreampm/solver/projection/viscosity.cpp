#include "dreampm/solver/projection/viscosity.h"

#include <algorithm>
#include <cmath>

#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

using Row = CellRows::Row;

/// Less than this part of a cell a face does not hold: it would take on any speed.
constexpr double least_face_mass = 0.01;

/// What two faces on either side of a collider's surface are apart outside of it, at least [cells].
constexpr double least_way = 0.1;

/// Of the first residual, and how often at most.
constexpr double viscous_tolerance = 1e-4;
constexpr int most_viscous_iterations = 400;

/// Rows over which sums are one piece.
constexpr std::size_t rows_of_a_sum = 64;

template <class R>
void clear_field(LargeVector<R>& v, std::size_t size) {
  resize_for_overwrite(v, size);
  parallel_ranges(size, 1 << 14, [&](std::size_t begin, std::size_t end) {
    std::fill(v.begin() + static_cast<std::ptrdiff_t>(begin), v.begin() + static_cast<std::ptrdiff_t>(end), R(0));
  });
}

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

/// The part of a cell that liquid fills.
template <class R>
R liquid_in(const MacGrid<R>& grid, std::size_t c) {
  return grid.solid_volume.empty() ? grid.density[c] : std::max(grid.density[c] - grid.solid_volume[c], R(0));
}

}  // namespace

template <class R>
R Viscosity<R>::stiffness(std::size_t a, const RowPlaces& at, std::size_t l) const {
  const std::size_t f = at.own + l;
  R sum = normal_[a][f] + normal_[a][at.low[a] + l];
  for (const std::size_t b : {next(a), after(a)}) {
    const LargeVector<R>& edges = shear_[3 - a - b];
    sum += edges[f] + edges[at.high[b] + l];
  }
  return sum;
}

template <class R>
void Viscosity<R>::weigh(MacGrid<R>& grid, double diffusion) {
  const std::size_t size = grid.cells.size();
  for (Faces* f :
       {&mass_, &inverse_, &velocity_, &residual_, &direction_, &product_, &normal_, &shear_, &pull_, &twist_})
    for (LargeVector<R>& v : *f) clear_field(v, size);
  const R s = static_cast<R>(diffusion);
  const auto given = [&](std::size_t a, std::size_t f) { return !(grid.open[a][f] > R(0)) || grid.is_in_holder(a, f); };
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l;
        if (given(a, f)) {
          velocity_[a][f] = grid.solid[a].empty() ? R(0) : grid.solid[a][f];
          // What flows through its open part sticks.
          if (grid.open[a][f] > R(0)) grid.free[a][f] = velocity_[a][f];
        } else if (is_known(grid.free[a][f])) {
          mass_[a][f] =
              std::max((liquid_in(grid, f) + liquid_in(grid, at.low[a] + l)) / 2, static_cast<R>(least_face_mass));
          if (!grid.solid_sums[a].empty()) mass_[a][f] += grid.solid_sums[a][f].weight;
          velocity_[a][f] = grid.free[a][f];
        }
      }
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(mass_[a]), grid.wrap(velocity_[a]);
  // Between the middle of a face in a collider and that of one outside: what is not in the
  // collider.
  const auto way = [&](std::size_t a, std::size_t one, std::size_t other) {
    if (grid.gap[a].empty()) return R(1);
    const R d = grid.gap[a][one], e = grid.gap[a][other];
    if ((d > R(0)) == (e > R(0))) return R(1);
    return std::max(std::max(d, e) / std::abs(d - e), static_cast<R>(least_way));
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
        normal_[a][c] = 2 * s * std::min(liquid_in(grid, c), R(1)) / way(a, c, at.high[a] + l);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // The edge along `axis`: faces of a beside one another along b, and the other way round.
        const std::size_t a = next(axis), b = after(axis);
        if (!grid.within(static_cast<int>(axis), cell[static_cast<int>(axis)])) continue;
        const std::size_t faces[4] = {c, at.low[b] + l, c, at.low[a] + l};
        const std::size_t along[4] = {a, a, b, b};
        const int walls[2] = {grid.wall_at(static_cast<int>(a), cell[static_cast<int>(a)]),
                              grid.wall_at(static_cast<int>(b), cell[static_cast<int>(b)])};
        if (walls[0] >= 0 && walls[1] >= 0) continue;
        R held = 0;
        bool whole = true;
        for (int n = 0; n < 4; ++n) {
          R mass = mass_[along[n]][faces[n]];
          if (!grid.solid_sums[0].empty()) mass -= grid.solid_sums[along[n]][faces[n]].weight;
          held += std::clamp(mass, R(0), R(1)) / 4;
          whole = whole && counts(along[n], faces[n]);
        }
        if (const int wall = std::max(walls[0], walls[1]); wall >= 0) {
          // The faces before the wall are half a cell from it: over half of a cell, twice the
          // slope.
          if (grid.holding.walls[static_cast<std::size_t>(wall)]) shear_[axis][c] = 8 * s * held;
          continue;
        }
        if (!whole) continue;
        bool slips = false;
        R open = 0;
        for (int n = 0; n < 4; ++n) {
          if (!given(along[n], faces[n]))
            open += R(1);
          else
            slips = slips || !grid.is_held(along[n], faces[n]);
        }
        if (!slips && open > R(0))
          shear_[axis][c] = s * held * 4 / (open * std::min(way(a, faces[0], faces[1]), way(b, faces[2], faces[3])));
      }
    }
  });
  for (std::size_t a = 0; a < 3; ++a) grid.wrap(normal_[a]), grid.wrap(shear_[a]);
  // The diagonal.
  for_all_rows(grid.cells.rows(), [&](const Row&, const RowPlaces& at) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t l = 0; l < row_cells; ++l) {
        const std::size_t f = at.own + l;
        if (!(mass_[a][f] > R(0))) continue;
        inverse_[a][f] = 1 / (mass_[a][f] + stiffness(a, at, l));
      }
  });
}

template <class R>
void Viscosity<R>::force(const MacGrid<R>& grid, const Faces& u, Faces& f) {
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
}

template <class R>
ViscousSolve Viscosity<R>::solve(World<R>& world, MacGrid<R>& grid, double diffusion, double density) {
  ViscousSolve out;
  weigh(grid, diffusion);
  bodies_.begin(world, grid, density,
                [&](std::size_t a, const RowPlaces& at, std::size_t l) { return stiffness(a, at, l); });
  const std::span<const Row> rows = grid.cells.rows();
  const auto each = [&](const auto& body) {
    for_all_rows(rows, [&](const Row&, const RowPlaces& at) {
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t c = at.own; c < at.own + row_cells; ++c)
          if (mass_[a][c] > R(0)) body(a, c);
    });
  };
  // Of faces, and of bodies.
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
  // Where the forces of stresses are, and minus what they do to the bodies.
  const auto apply = [&](const Faces& u, Faces& f, std::vector<Six>& bodies) {
    force(grid, u, f);
    bodies_.gather(f, bodies);
  };
  body_velocity_.assign(bodies_.size(), {}), body_direction_.assign(bodies_.size(), {});
  // From the velocities before: what is missing is the force of their stresses.
  apply(velocity_, residual_, body_residual_);
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
    apply(direction_, product_, body_product_);
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
  each([&](std::size_t a, std::size_t c) { grid.free[a][c] = velocity_[a][c]; });
  for (auto& f : grid.free) grid.wrap(f);
  bodies_.move(world, body_velocity_);
  return out;
}

template class Viscosity<float>;
template class Viscosity<double>;

}  // namespace dreampm
