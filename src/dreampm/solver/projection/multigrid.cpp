#include "dreampm/solver/projection/multigrid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/solver/projection/fill_field.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// Coefficients of a level over the sums of those of the finer one.
constexpr double aggregate_scale = 0.5;
/// Cells an edge up to which a level is not made coarser, and the sweeps that solve it.
constexpr int coarsest_cells = 4;
constexpr int coarsest_sweeps = 12;
/// Rows that a thread takes at a time, and over which sums are one piece.
constexpr std::size_t grain = 128;

using Row = CellRows::Row;

template <class Body>
void for_rows(const std::vector<Row>& rows, const Body& body) {
  parallel_ranges(rows.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) body(n, rows[n]);
  });
}

constexpr std::size_t place(std::uint32_t row) { return std::size_t{row} * row_cells; }

/// A sum over rows of what body(begin, end) gives for each piece of them, in a fixed order.
template <class Body>
double sum_over(const std::vector<Row>& rows, std::vector<double>& parts, const Body& body) {
  const std::size_t pieces = (rows.size() + grain - 1) / grain;
  resize_for_overwrite(parts, pieces);
  parallel_for(pieces, 1, [&](std::size_t piece) {
    parts[piece] = body(piece * grain, std::min(rows.size(), (piece + 1) * grain));
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

/// Sizes a level for some rows with unknowns: the values of the others read as 0.
template <class R>
void lay(PressureLevel<R>& level, const CellRows& cells) {
  for (auto* v : {&level.diagonal, &level.low[0], &level.low[1], &level.low[2], &level.x, &level.b, &level.r})
    fill_field(*v, cells.size(), R(0));
  resize_for_overwrite(level.inverse, cells.size());
  level.rows.clear();
}

/// Sizes a level for all rows.
template <class R>
void lay_whole(PressureLevel<R>& level, const CellRows& cells) {
  for (auto* v : {&level.diagonal, &level.low[0], &level.low[1], &level.low[2], &level.x, &level.b, &level.r}) {
    resize_for_overwrite(*v, cells.size());
    cells.fill_outside(v->data(), R(0));
  }
  resize_for_overwrite(level.inverse, cells.size());
  level.rows.assign(cells.rows().begin(), cells.rows().end());
}

}  // namespace

template <class R>
void PressureSolver<R>::begin(const CellRows& cells, int longest) {
  cells_ = &cells;
  pockets_.clear();
  depth_ = 1;
  for (int n = longest; n > coarsest_cells; n = (n + 1) / 2) ++depth_;
  if (levels_.size() < depth_) levels_.resize(depth_), coarse_.resize(depth_), parents_.resize(depth_);
  lay(levels_.front(), cells);
  fill_field(direction_, cells.size(), R(0));
  resize_for_overwrite(product_, cells.size());
}

template <class R>
void PressureSolver<R>::set_up() {
  cells_->wrap(levels_.front().low[2].data());
  const CellRows* fine_cells = cells_;
  for (std::size_t l = 0; l + 1 < depth_; ++l) {
    PressureLevel<R>&fine = levels_[l], &level = levels_[l + 1];
    Coarse& coarse = coarse_[l];
    coarse.cells.lay_coarser(*fine_cells, fine.rows);
    lay_whole(level, coarse.cells);
    coarse.children.resize(level.rows.size());
    resize_for_overwrite(parent_of_, fine_cells->size() / row_cells);
    for_rows(level.rows, [&](std::size_t n, const Row& row) {
      for (int part = 0; part < 8; ++part) {
        const int i = part >> 2, j = part >> 1 & 1, half = part & 1;
        const std::uint32_t child =
            fine_cells->row_of({2 * row.first.x + i, 2 * row.first.y + j, 2 * row.first.z + half * row_cells});
        coarse.children[n][static_cast<std::size_t>(part)] = child;
        if (child != CellRows::outside)
          parent_of_[child] =
              static_cast<std::uint32_t>(place(row.number) + static_cast<std::size_t>(half) * row_cells / 2);
      }
    });
    parallel_ranges(level.rows.size(), grain, [&](std::size_t begin, std::size_t end) {
      kernels_.coarsen(fine.as_rows(), level.as_rows(), level.as_matrix(), begin, end, coarse.children.data(),
                       static_cast<R>(aggregate_scale));
    });
    parents_[l].resize(fine.rows.size());
    for_rows(fine.rows, [&](std::size_t n, const Row& row) { parents_[l][n] = parent_of_[row.number]; });
    fine_cells = &coarse.cells;
  }
  for (std::size_t l = 0; l < depth_; ++l)
    parallel_ranges(levels_[l].rows.size(), grain, [&](std::size_t begin, std::size_t end) {
      kernels_.invert(levels_[l].as_rows(), begin, end, levels_[l].inverse.data());
    });
}

template <class R>
double PressureSolver<R>::cycle(std::size_t l) {
  PressureLevel<R>& fine = levels_[l];
  const LevelRows<R> rows = fine.as_rows();
  const CellRows& cells = l == 0 ? *cells_ : coarse_[l - 1].cells;
  const auto over = [&](const auto& body) { parallel_ranges(fine.rows.size(), grain, body); };
  const auto wrap = [&] { cells.wrap(fine.x.data()); };
  const auto sweep = [&](int color) {
    over([&](std::size_t begin, std::size_t end) { kernels_.half_sweep(rows, begin, end, color); });
    wrap();
  };
  over([&](std::size_t begin, std::size_t end) { kernels_.first_half_sweep(rows, begin, end, 0); });
  wrap();
  sweep(1);
  if (l + 1 == depth_) {
    for (int n = 1; n < coarsest_sweeps; ++n) sweep(0), sweep(1);
    for (int n = 1; n < coarsest_sweeps; ++n) sweep(1), sweep(0);
  } else {
    over([&](std::size_t begin, std::size_t end) { kernels_.residual(rows, begin, end, fine.r.data()); });
    PressureLevel<R>& level = levels_[l + 1];
    const Coarse& coarse = coarse_[l];
    parallel_ranges(level.rows.size(), grain, [&](std::size_t begin, std::size_t end) {
      kernels_.gather(level.as_rows(), begin, end, coarse.children.data(), fine.r.data());
    });
    cycle(l + 1);
    over([&](std::size_t begin, std::size_t end) {
      kernels_.spread(rows, begin, end, parents_[l].data(), level.x.data());
    });
    wrap();
  }
  sweep(1);
  const double product = sum_over(fine.rows, parts_, [&](std::size_t begin, std::size_t end) {
    return kernels_.last_half_sweep(rows, begin, end, 0);
  });
  wrap();
  return product;
}

template <class R>
void PressureSolver<R>::find_pockets() {
  const PressureLevel<R>& level = levels_.front();
  pockets_.clear(), pocket_cells_.clear();
  // Cells that are coupled have one root.
  std::vector<std::uint32_t>& root = roots_;
  root.resize(cells_->size());
  std::iota(root.begin(), root.end(), 0U);
  const auto root_of = [&](std::size_t c) {
    while (root[c] != c) c = root[c] = root[root[c]];
    return c;
  };
  const auto join = [&](std::size_t a, std::size_t b) {
    const std::size_t i = root_of(a), j = root_of(b);
    root[std::max(i, j)] = static_cast<std::uint32_t>(std::min(i, j));
  };
  for (const Row& row : level.rows)
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = place(row.number) + l;
      if (level.low[0][c] > R(0)) join(c, place(row.x_low) + l);
      if (level.low[1][c] > R(0)) join(c, place(row.y_low) + l);
      if (level.low[2][c] > R(0)) join(c, c - 1);
    }
  cells_->for_copies([&](std::size_t from, std::size_t to) {
    if (level.diagonal[from] > R(0)) join(from, to);
  });
  // One that has a surface somewhere is none.
  std::vector<std::uint8_t>& open = open_;
  open.assign(cells_->size(), 0);
  for (const Row& row : level.rows) {
    const std::size_t first = place(row.number), xh = place(row.x_high), yh = place(row.y_high);
    for (std::size_t l = 0; l < row_cells; ++l) {
      const std::size_t c = first + l;
      const R coupled = level.low[0][c] + level.low[0][xh + l] + level.low[1][c] + level.low[1][yh + l] +
                        level.low[2][c] + level.low[2][c + 1];
      if (level.diagonal[c] > coupled * static_cast<R>(1 + 1e-5)) open[root_of(c)] = 1;
    }
  }
  auto& found = found_;
  found.clear();
  for (const Row& row : level.rows)
    for (std::size_t c = place(row.number); c < place(row.number) + row_cells; ++c)
      if (const std::size_t r = root_of(c); level.diagonal[c] > R(0) && !open[r])
        found.emplace_back(static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  std::sort(found.begin(), found.end());
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (n == 0 || found[n].first != found[n - 1].first) pockets_.push_back(n);
    pocket_cells_.push_back(found[n].second);
  }
  if (!pockets_.empty()) pockets_.push_back(found.size());
}

template <class R>
void PressureSolver<R>::balance_pockets() {
  LargeVector<R>& b = levels_.front().b;
  for_pockets([&](std::span<const std::uint32_t> cells) {
    double sum = 0;
    for (const std::uint32_t c : cells) sum += static_cast<double>(b[c]);
    const R mean = static_cast<R>(sum / static_cast<double>(cells.size()));
    for (const std::uint32_t c : cells) b[c] -= mean;
  });
}

template <class R>
void PressureSolver<R>::lift_pockets(LargeVector<R>& x) const {
  for_pockets([&](std::span<const std::uint32_t> cells) {
    R least = x[cells.front()];
    for (const std::uint32_t c : cells) least = std::min(least, x[c]);
    for (const std::uint32_t c : cells) x[c] -= least;
  });
  cells_->wrap(x.data());
}

template <class R>
double PressureSolver<R>::norm_of_right_side() {
  const PressureLevel<R>& level = levels_.front();
  return std::sqrt(sum_over(level.rows, parts_, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t n = begin; n < end; ++n)
      for (std::size_t c = place(level.rows[n].number); c < place(level.rows[n].number) + row_cells; ++c)
        sum += static_cast<double>(level.b[c]) * static_cast<double>(level.b[c]);
    return sum;
  }));
}

template <class R>
void PressureSolver<R>::apply(const LargeVector<R>& x, LargeVector<R>& y) {
  kernels_.product(levels_.front().as_rows(), 0, levels_.front().rows.size(), x.data(), y.data());
}

template <class R>
typename PressureSolver<R>::Result PressureSolver<R>::solve(LargeVector<R>& x, double tolerance, double scale, int most,
                                                            AddedOperator<R>* added) {
  PressureLevel<R>& level = levels_.front();
  const LevelRows<R> rows = level.as_rows();
  const auto sum = [&](const auto& body) { return sum_over(level.rows, parts_, body); };
  Result out;
  cells_->wrap(x.data());
  // The right side becomes the residual.
  double square =
      sum([&](std::size_t begin, std::size_t end) { return kernels_.take_off(rows, begin, end, x.data()); });
  if (added) {
    added->add(x, R(-1), level.b);
    const double norm = norm_of_right_side();
    square = norm * norm;
  }
  out.residual = std::sqrt(square);
  const double stop = tolerance * scale;
  double rho = 0;
  while (out.residual > stop && out.iterations < most) {
    const double before = std::exchange(rho, cycle(0));
    const R beta = out.iterations > 0 ? static_cast<R>(rho / before) : R(0);
    parallel_ranges(level.rows.size(), grain, [&](std::size_t begin, std::size_t end) {
      kernels_.turn(rows, begin, end, beta, direction_.data());
    });
    cells_->wrap(direction_.data());
    double curvature = sum([&](std::size_t begin, std::size_t end) {
      return kernels_.product(rows, begin, end, direction_.data(), product_.data());
    });
    if (added) curvature += added->add(direction_, R(1), product_);
    if (!(curvature > 0)) break;
    const R alpha = static_cast<R>(rho / curvature);
    square = sum([&](std::size_t begin, std::size_t end) {
      return kernels_.advance(rows, begin, end, alpha, direction_.data(), product_.data(), x.data());
    });
    ++out.iterations;
    out.residual = std::sqrt(square);
  }
  cells_->wrap(x.data());
  return out;
}

template class PressureSolver<float>;
template class PressureSolver<double>;

}  // namespace dreampm
