// The parts of a projection: rows of cells, the surface, transfers, the pressure equation.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

#include "dreampm/physics/projection/surface.h"
#include "dreampm/physics/projection/trilinear.h"
#include "dreampm/solver/projection/multigrid.h"

namespace dreampm::projection_grid_test {
namespace {

// The grid of rows.

TEST(CellRows, ARowAndItsNeighborsAreWhereTheirCellsAre) {
  CellRows rows;
  // Two columns, one with a gap along z, and blocks whose other half of a tile is missing.
  std::vector<Vec3i> blocks{{-1, 0, -3}, {-1, 0, 0}, {-1, 0, 1}, {-1, 0, 2},
                            {-1, 0, 6},  {0, 0, 1},  {0, 1, 1},  {4, 4, 4}};
  rows.begin(blocks), rows.mark_all(), rows.finish();
  std::set<std::size_t> taken;
  for (const CellRows::Row& row : rows.rows()) {
    for (int k = 0; k < row_cells; ++k) {
      const std::size_t at = rows.place_of(row.first + Vec3i{0, 0, k});
      EXPECT_EQ(at, std::size_t{row.number} * row_cells + static_cast<std::size_t>(k));
      EXPECT_TRUE(taken.insert(at).second);
      EXPECT_LT(at + 1, rows.size());
    }
    EXPECT_EQ(row.x_low, rows.row_of(row.first - Vec3i{1, 0, 0}));
    EXPECT_EQ(row.x_high, rows.row_of(row.first + Vec3i{1, 0, 0}));
    EXPECT_EQ(row.y_low, rows.row_of(row.first - Vec3i{0, 1, 0}));
    EXPECT_EQ(row.y_high, rows.row_of(row.first + Vec3i{0, 1, 0}));
  }
  for (const Vec3i& b : blocks) EXPECT_NE(rows.row_of(b * block_width), CellRows::outside);
  // Beside a row along z lies the next one, or what belongs to no cell.
  for (const CellRows::Row& row : rows.rows())
    for (const int k : {-1, row_cells}) {
      const std::size_t beside = std::size_t{row.number} * row_cells + static_cast<std::size_t>(k);
      const std::uint32_t next = rows.row_of(row.first + Vec3i{0, 0, k});
      EXPECT_EQ(taken.contains(beside), next != CellRows::outside);
      if (next != CellRows::outside) {
        EXPECT_EQ(beside, rows.place_of(row.first + Vec3i{0, 0, k}));
      }
    }
  EXPECT_EQ(taken.size(), 7 * tile_rows * row_cells);  // (-1, 0, 0) and (-1, 0, 1) share a tile
}

/// Cells in the order of their coordinates.
struct CellLess {
  bool operator()(const Vec3i& a, const Vec3i& b) const { return block_less(a, b); }
};
using Cells = std::set<Vec3i, CellLess>;

TEST(CellRows, RowsAreThereWhereTheirCellsAreWanted) {
  // Blocks 0 to 5 along each axis; along z the ends meet.
  const int wide = 24;
  std::vector<Vec3i> blocks;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) blocks.push_back({i, j, k});
  CellRows rows;
  rows.begin(blocks, {0, 0, wide / row_cells});
  Cells wanted;
  const auto want = [&](Vec3i cell) {
    cell.z = (cell.z + wide) % wide;
    if (std::min(cell.x, cell.y) >= 0 && std::max(cell.x, cell.y) < wide) wanted.insert(cell);
  };
  for (const Vec3i& first : {Vec3i{3, 4, 6}, {3, 4, 0}, {0, 9, 23}, {23, 23, 12}, {12, 7, 3}}) {
    rows.mark(first, 0b101);
    for (const int k : {0, 2}) want(first + Vec3i{0, 0, k});
  }
  const auto spread = [&](bool around) {
    for (const Vec3i& cell : Cells(wanted))
      for (int a = 0; a < 3; ++a) {
        Vec3i step{};
        step[a] = 1;
        want(cell + step);
        if (around) want(cell - step);
      }
  };
  rows.spread(CellRows::Spread::high), spread(false);
  rows.spread(CellRows::Spread::around), spread(true);
  // Cells behind planes, in the same tile and in the next.
  for (const auto& [axis, from, to] : {std::array{0, 4, 3}, {1, 5, 6}, {2, 7, 8}}) {
    rows.mark_beside(axis, from, to);
    for (Vec3i cell : Cells(wanted))
      if (cell[axis] == from) cell[axis] = to, want(cell);
  }
  rows.finish();

  Cells row_starts;
  for (const Vec3i& cell : wanted) row_starts.insert({cell.x, cell.y, cell.z / row_cells * row_cells});
  EXPECT_EQ(rows.rows().size(), row_starts.size());
  EXPECT_LT(row_starts.size(), std::size_t{wide} * wide / 2);
  for (const CellRows::Row& row : rows.rows()) EXPECT_TRUE(row_starts.contains(row.first));
  // One level up, where any of eight cells is.
  CellRows coarse;
  coarse.lay_coarser(rows, rows.rows());
  Cells coarse_starts;
  for (const Vec3i& at : row_starts) coarse_starts.insert({at.x / 2, at.y / 2, at.z / 2 / row_cells * row_cells});
  EXPECT_EQ(coarse.rows().size(), coarse_starts.size());
  for (const CellRows::Row& row : coarse.rows()) EXPECT_TRUE(coarse_starts.contains(row.first));
}

// The surface.

TEST(LiquidSurface, TheDepthUnderAFlatSurfaceIsExact) {
  for (const double depth : {-0.9, -0.5, -0.1, 0.1, 0.5, 0.9}) {
    // The reading of a tent of unit width on each side over the half-space below `depth`.
    const double read = depth > 0 ? 1 - 0.5 * (1 - depth) * (1 - depth) : 0.5 * (1 + depth) * (1 + depth);
    EXPECT_NEAR(depth_of(read), depth, 1e-12) << depth;
  }
  EXPECT_EQ(depth_of(2.0), 1);
  EXPECT_EQ(depth_of(0.0), -1);
}

TEST(LiquidSurface, PressureIsZeroWhereTheSurfaceIs) {
  EXPECT_DOUBLE_EQ(inverse_theta(0.25, -0.75), 4);
  EXPECT_DOUBLE_EQ(inverse_theta(-0.75, 0.25), 4);
  EXPECT_DOUBLE_EQ(inverse_theta(0.001, -1.0), 1 / LiquidSurface::least_theta);
  EXPECT_DOUBLE_EQ(inverse_theta(0.5, 0.5), 1);
}

TEST(Trilinear, ALinearFieldComesBackWithItsSlope) {
  const auto field = [](double x, double y, double z) { return 1 + 2 * x - 3 * y + 5 * z; };
  const StaggeredPlace<double> place(Four<double>{2.25, 1.0, 1.625, 0});
  // Faces of x lie half a cell on along y and z.
  const TrilinearCell<double> cell = place.faces(0);
  Corners<double> at;
  for (int n = 0; n < 8; ++n)
    (n < 4 ? at.low : at.high)[n & 3] =
        field(cell.first[0] + (n >> 2), cell.first[1] + 0.5 + (n >> 1 & 1), cell.first[2] + 0.5 + (n & 1));
  Four<double> found;
  trilinear_slope(cell, at, found);
  EXPECT_DOUBLE_EQ(found[0], field(2.25, 1, 1.625));
  Samples<double> samples;
  for (int n = 0; n < 8; ++n) samples.at[n >> 2][n >> 1 & 1][n & 1] = (n < 4 ? at.low : at.high)[n & 3];
  EXPECT_DOUBLE_EQ(trilinear_value(way_of(cell), samples), found[0]);
  EXPECT_DOUBLE_EQ(found[1], 2);
  EXPECT_DOUBLE_EQ(found[2], -3);
  EXPECT_DOUBLE_EQ(found[3], 5);
}

TEST(Trilinear, AParticleGivesItsMassAndItsAffineMotion) {
  const TrilinearCell<double> cell = StaggeredPlace<double>(Four<double>{2.25, 1.0, 1.625, 0}).faces(1);
  const Four<double> motion{3, 2, -1, 4};
  Four<double> given[4];
  given_to_faces(cell, motion, given);
  double weight = 0, momentum = 0;
  for (int n = 0; n < 4; ++n)
    for (int k = 0; k < 2; ++k) {
      const double w = given[n][2 * k + 1];
      weight += w, momentum += given[n][2 * k];
      const double there = 3 + 2 * ((n >> 1) - cell.way[0]) - ((n & 1) - cell.way[1]) + 4 * (k - cell.way[2]);
      EXPECT_NEAR(given[n][2 * k], w * there, 1e-14);
    }
  EXPECT_NEAR(weight, 1, 1e-14);
  EXPECT_NEAR(momentum, 3, 1e-14);
  const Corners<double> shares = shares_of_centers(cell);
  const Four<double> all = shares.low + shares.high;
  EXPECT_NEAR(all[0] + all[1] + all[2] + all[3], 1, 1e-14);
}

// The pressure equation.

/// A blob of unknowns with random couplings: its rows as equations, densely.
struct Blob {
  CellRows cells;
  PressureSolver<double> solver;
  std::vector<std::size_t> unknowns;  ///< their places
  std::vector<std::vector<double>> dense;
  LargeVector<double> b;

  Blob() {
    std::vector<Vec3i> blocks;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 3; ++k) blocks.push_back({i, j, k});
    cells.begin(blocks), cells.mark_all(), cells.finish();
    solver.begin(cells, 12);
    PressureLevel<double>& m = solver.matrix();
    std::mt19937 dice(3);
    std::uniform_real_distribution<double> part(0, 1);
    const auto liquid = [](const Vec3i& c) {
      const Vec3d d = static_cast<Vec3d>(c) - Vec3d{5.2, 3.8, 5.9};
      return dot(d, d) < 14 || (c.x == 10 && c.y == 2);
    };
    for (const CellRows::Row& row : cells.rows()) m.rows.push_back(row);
    for (const CellRows::Row& row : cells.rows())
      for (int k = 0; k < row_cells; ++k) {
        const Vec3i cell = row.first + Vec3i{0, 0, k};
        if (!liquid(cell)) continue;
        const std::size_t at = cells.place_of(cell);
        unknowns.push_back(at);
        for (int a = 0; a < 3; ++a) {
          Vec3i below = cell;
          below[a] -= 1;
          const double open = part(dice) < 0.2 ? 0 : part(dice);
          m.diagonal[at] += open;
          if (liquid(below)) {
            m.low[static_cast<std::size_t>(a)][at] = open;
            m.diagonal[cells.place_of(below)] += open;
          }
        }
        m.diagonal[at] += 0.05;  // some surface
        m.b[at] = part(dice) - 0.5;
      }
    b = m.b;
    dense.assign(unknowns.size(), std::vector<double>(unknowns.size()));
    LargeVector<double> unit(cells.size(), 0), column(cells.size(), 0);
    for (std::size_t n = 0; n < unknowns.size(); ++n) {
      unit[unknowns[n]] = 1;
      solver.apply(unit, column);
      unit[unknowns[n]] = 0;
      for (std::size_t i = 0; i < unknowns.size(); ++i) dense[i][n] = column[unknowns[i]];
    }
  }
  /// By Gaussian elimination.
  std::vector<double> exact() const {
    auto a = dense;
    std::vector<double> x;
    for (const std::size_t at : unknowns) x.push_back(b[at]);
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t r = i + 1; r < n; ++r) {
        const double f = a[r][i] / a[i][i];
        for (std::size_t c = i; c < n; ++c) a[r][c] -= f * a[i][c];
        x[r] -= f * x[i];
      }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t c = i + 1; c < n; ++c) x[i] -= a[i][c] * x[c];
      x[i] /= a[i][i];
    }
    return x;
  }
};

TEST(PressureSolver, SolvesWhatADenseEliminationSolves) {
  Blob blob;
  blob.solver.set_up();
  LargeVector<double> x(blob.cells.size(), 0);
  const auto result = blob.solver.solve(x, 1e-12, blob.solver.norm_of_right_side(), 60);
  EXPECT_LE(result.iterations, 25);
  const std::vector<double> exact = blob.exact();
  for (std::size_t n = 0; n < exact.size(); ++n) EXPECT_NEAR(x[blob.unknowns[n]], exact[n], 1e-9) << n;
  ASSERT_GT(exact.size(), 200u);
}

TEST(PressureSolver, TheMultigridTakesFewIterationsInADeepTank) {
  // A tank of 64^3 cells with a free surface: without a coarse level it takes hundreds.
  std::vector<Vec3i> blocks;
  for (int n = 0; n < 16 * 16 * 16; ++n) blocks.push_back({n / 256, n / 16 % 16, n % 16});
  CellRows cells;
  cells.begin(blocks), cells.mark_all(), cells.finish();
  PressureSolver<float> solver;
  solver.begin(cells, 64);
  PressureLevel<float>& m = solver.matrix();
  m.rows.assign(cells.rows().begin(), cells.rows().end());
  std::mt19937 dice(5);
  std::uniform_real_distribution<float> source(-1, 1);
  for (const CellRows::Row& row : m.rows)
    for (int k = 0; k < row_cells; ++k) {
      const Vec3i c = row.first + Vec3i{0, 0, k};
      const std::size_t at = cells.place_of(c);
      for (int a = 0; a < 3; ++a) {
        m.low[static_cast<std::size_t>(a)][at] = c[a] > 0 ? 1.f : 0.f;
        m.diagonal[at] += (c[a] > 0) + (c[a] < 63);
      }
      if (c.y == 63) m.diagonal[at] += 2;
      m.b[at] = source(dice);
    }
  solver.set_up();
  LargeVector<float> x(cells.size(), 0.f);
  EXPECT_LE(solver.solve(x, 1e-4, solver.norm_of_right_side(), 60).iterations, 14);
}

}  // namespace
}  // namespace dreampm::projection_grid_test
