// The pressure equation on cells: conjugate gradients, preconditioned by one V-cycle of a multigrid
// of aggregates. Cells of two by two by two make one of the next level, and the coefficients of a
// level are sums of those of the finer one, halved: constant prolongation makes errors too stiff
// (Weber, Mueller-Roemer, Stork and Fellner 2015). So any cut cell and any drop is treated alike.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dreampm/base/large_vector.h"
#include "dreampm/math/vec.h"
#include "dreampm/solver/projection/cell_rows.h"
#include "dreampm/solver/projection/kernels.h"

namespace dreampm {

/// One level. A cell whose diagonal is 0 is no unknown.
template <class R>
struct PressureLevel {
  LargeVector<R> diagonal, inverse;
  std::array<LargeVector<R>, 3> low;  ///< coupling to the cell on the low side of each axis, 0 or more
  LargeVector<R> x, b, r;
  std::vector<CellRows::Row> rows;  ///< those with unknowns
  MatrixRows<R> as_matrix() { return {diagonal.data(), {low[0].data(), low[1].data(), low[2].data()}, b.data()}; }
  LevelRows<R> as_rows() {
    return {rows.data(), diagonal.data(), inverse.data(), {low[0].data(), low[1].data(), low[2].data()},
            x.data(),    b.data()};
  }
};

/// An operator that is added to the matrix without being stored: symmetric, and not negative.
template <class R>
class AddedOperator {
 public:
  virtual ~AddedOperator() = default;
  /// y += scale B x, in rows with unknowns; returns x . B x. The same bits for any number of
  /// threads.
  virtual double add(const LargeVector<R>& x, R scale, LargeVector<R>& y) = 0;
};

template <class R>
class PressureSolver {
 public:
  struct Result {
    int iterations = 0;
    double residual = 0;  ///< its norm
  };

  explicit PressureSolver(const MultigridKernels<R>& kernels = projection_kernels<R>("auto").multigrid)
      : kernels_(kernels) {}
  /// Sizes the arrays over `cells`, all of them 0; before the matrix is filled. `cells` must stay
  /// as it is until the next call. `longest`: cells along the longest axis of the domain.
  void begin(const CellRows& cells, int longest);
  /// Returns the matrix to be filled: diagonal, low, b, and rows.
  PressureLevel<R>& matrix() { return levels_.front(); }
  /// Sets up the coarser levels; after the matrix is filled.
  void set_up();
  /// Finds the liquid that has no surface, such as that of a full vessel; after the matrix is
  /// filled. Its pressure is known but for a constant, and only where inflow and outflow are equal.
  void find_pockets();
  /// Makes the right side one that has a solution.
  void balance_pockets();
  /// Makes the least pressure of each pocket 0.
  void lift_pockets(LargeVector<R>& x) const;
  /// sqrt(b . b) of the right side as it stands.
  double norm_of_right_side();
  /// Solves A x = b from `x` as it is, until |b - A x| <= tolerance * scale or after `most`
  /// iterations. Overwrites the right side. The same bits for any number of threads. `added`: to A,
  /// or null; the cycle does not know of it.
  Result solve(LargeVector<R>& x, double tolerance, double scale, int most, AddedOperator<R>* added = nullptr);
  /// y = A x, over the rows with unknowns; for tests.
  void apply(const LargeVector<R>& x, LargeVector<R>& y);

 private:
  struct Coarse {
    CellRows cells;
    /// For each row, the rows of the finer level of which it is made: by (i * 2 + j) * 2 + half
    /// along z.
    std::vector<std::array<std::uint32_t, 8>> children;
  };
  /// Returns x . b of the level.
  double cycle(std::size_t level);
  template <class Body>
  void for_pockets(const Body& body) const {
    for (std::size_t p = 0; p + 1 < pockets_.size(); ++p)
      body(std::span(pocket_cells_).subspan(pockets_[p], pockets_[p + 1] - pockets_[p]));
  }

  const MultigridKernels<R>& kernels_;
  const CellRows* cells_ = nullptr;
  std::vector<PressureLevel<R>> levels_;
  std::vector<Coarse> coarse_;  ///< of levels_[l + 1]
  std::size_t depth_ = 0;       ///< levels in use
  /// For each row with unknowns of a level but the last, the place of its first cell's aggregate.
  std::vector<std::vector<std::uint32_t>> parents_;
  std::vector<std::uint32_t> parent_of_;  ///< the same by the numbers of rows, for one level at a time
  LargeVector<R> direction_, product_;
  std::vector<std::uint32_t> roots_, pocket_cells_;             ///< the cells of pockets, one pocket after the other
  std::vector<std::size_t> pockets_;                            ///< where each begins, and the end
  std::vector<std::uint8_t> open_;                              ///< of roots: whether there is a surface
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found_;  ///< roots and cells of pockets
  std::vector<double> parts_;
};

}  // namespace dreampm
