// The cells of a projection: rows of eight along z, where matter is near. Rows are found by tiles
// of 4 x 4 of them. A cell has the coordinates of its node of lowest coordinates, and so has the
// face of each axis on its low side.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "dreampm/math/scalar.h"
#include "dreampm/state/grid.h"

namespace dreampm {

inline constexpr int row_cells = 8;
inline constexpr int tile_rows = block_width * block_width;
/// Cells between the ends of a periodic axis are a multiple of this: cells of one color of the
/// solve, and blocks of one color of the transfers, are then no neighbors there either.
inline constexpr int period_cells = 8;

/// The tile that a block of the grid is half of.
constexpr Vec3i tile_of_block(const Vec3i& block) { return {block.x, block.y, block.z >> 1}; }
/// The tile of a cell, for any sign.
constexpr Vec3i tile_of_cell(const Vec3i& cell) { return {cell.x >> 2, cell.y >> 2, cell.z >> 3}; }

/// The place of each row of cells in the arrays of a grid. Rows that follow one another along z are
/// one piece of memory, with a row before and after that belongs to no cell, so that the neighbors
/// of a cell along z are those beside it in memory. Values of rows that belong to no cell stand for
/// all that is outside. `begin` says which tiles there may be, `mark` and `spread` which cells are
/// wanted, and `finish` lays the rows that hold any of them.
class CellRows {
 public:
  struct Row {
    Vec3i first;                                 ///< its first cell
    std::uint32_t number;                        ///< its cells are [8 number, 8 number + 8) of an array
    std::uint32_t x_low, x_high, y_low, y_high;  ///< the rows beside it; `outside` where there is none
  };
  /// A row that belongs to no cell; so does the next one.
  static constexpr std::uint32_t outside = 0;

  /// `blocks`: of the grid, in order: cells of others are not there. `period`: tiles between the
  /// two ends of an axis that meet, where tile 0 is the first; 0 of other axes. Keeps its memory.
  void begin(const std::vector<Vec3i>& blocks, const Vec3i& period = {});
  /// Marks cells of a column: bit k is the cell `first` + k along z. Any number of threads at once.
  void mark(const Vec3i& first, std::uint8_t bits);
  /// Marks all cells.
  void mark_all();
  enum class Spread : std::uint8_t { high, around };
  /// Marks the cells beside marked ones: on the high side of each axis, or on both.
  void spread(Spread to);
  /// Marks the cells at `to` along an axis, beside those at `from`, where these are marked.
  void mark_beside(int axis, std::int32_t from, std::int32_t to);
  void finish();
  /// The rows of a level that is half as fine: a cell of it is two by two by two of `fine`. `rows`:
  /// those of `fine` that matter.
  void lay_coarser(const CellRows& fine, std::span<const Row> rows);

  /// The length of an array over all rows.
  std::size_t size() const { return row_count_ * row_cells; }
  /// Returns the rows in the order of their memory.
  std::span<const Row> rows() const { return rows_; }
  /// Sets what belongs to no cell in an array over all rows.
  template <class T>
  void fill_outside(T* field, T value) const {
    for (const std::uint32_t row : outside_) std::fill_n(field + std::size_t{row} * row_cells, row_cells, value);
  }
  /// The number of the row that a cell is in; `outside` where there is none.
  std::uint32_t row_of(const Vec3i& cell) const;
  /// The place of a cell in an array; one that belongs to no cell where there is none.
  std::size_t place_of(const Vec3i& cell) const {
    const std::uint32_t row = row_of(cell);
    return std::size_t{row} * row_cells + static_cast<std::size_t>(cell.z & (row_cells - 1));
  }
  /// Cells beyond the two ends of a periodic z axis, four to either side, are copies of those at
  /// the other end: writes them. Along x and y rows beside one another are neighbors without.
  template <class T>
  void wrap(T* field) const {
    for (const auto& [from, to] : copies_) std::copy_n(field + from, copied_cells, field + to);
  }
  /// Adds what was added to the copies to the cells themselves; then the copies are 0.
  template <class T>
  void fold(T* field) const {
    for (const auto& [from, to] : copies_)
      for (std::size_t n = 0; n < copied_cells; ++n) field[from + n] += std::exchange(field[to + n], T{});
  }
  /// Calls body(cell, its copy) for all of them, by their places.
  template <class Body>
  void for_copies(const Body& body) const {
    for (const auto& [from, to] : copies_)
      for (std::size_t n = 0; n < copied_cells; ++n) body(from + n, to + n);
  }
  bool wraps() const { return !copies_.empty(); }

  /// A tile by the numbers of its rows, (i, j) at i * 4 + j; `outside` where there is none.
  struct Tile {
    std::array<std::uint32_t, tile_rows> rows{};
    std::uint32_t number(int i, int j) const { return rows[static_cast<std::size_t>(i * block_width + j)]; }
    /// The place in an array of a cell that lies `before` cells before row (i, j), up to eight,
    /// along z: cells from there to the eighth after that row are beside one another. One from
    /// which sixteen belong to no cell where the row is not there.
    std::size_t place_before(int i, int j, std::size_t before) const {
      return number(i, j) == outside ? 0 : std::size_t{number(i, j)} * row_cells - before;
    }
  };
  /// Calls body(n, place) for the cells of a block that are there, n by node_index().
  template <class Body>
  void for_block(const Vec3i& block, const Body& body) const {
    for_block_rows(block, [&](std::size_t n, std::size_t place) {
      for (std::size_t k = 0; k < block_width; ++k) body(n + k, place + k);
    });
  }
  /// Calls body(n, place) for the rows of a block that are there: four cells from number n on, by
  /// node_index(), lie one after the other from `place` on.
  template <class Body>
  void for_block_rows(const Vec3i& block, const Body& body) const {
    const Tile* const tile = find_tile(block * block_width);
    if (!tile) return;
    for (std::size_t n = 0; n < tile_rows; ++n)
      if (tile->rows[n] != outside)
        body(n * block_width,
             std::size_t{tile->rows[n]} * row_cells + static_cast<std::size_t>((block.z & 1) * block_width));
  }
  /// The tile that a cell is in; null where there is none.
  const Tile* find_tile(const Vec3i& cell) const {
    const std::int32_t t = tiles_.find(wrapped(tile_of_cell(cell)));
    return t == BlockList::none ? nullptr : &places_[static_cast<std::size_t>(t)];
  }
  /// Calls body(x, y, tile) for the tiles from that of a cell on, `width` cells along x and y: in
  /// the plane of its z, by the first cell of each; null where there is none.
  template <class Body>
  void for_tiles_around(const Vec3i& first, int width, const Body& body) const {
    constexpr std::int32_t unknown = -2;
    const Vec3i begin = tile_of_cell(first), last = tile_of_cell(first + Vec3i{width - 1, width - 1, 0});
    for (Vec3i at = begin; at.x <= last.x; ++at.x) {
      std::int32_t t = unknown;
      for (at.y = begin.y; at.y <= last.y; ++at.y) {
        // Most are beside one another.
        t = t >= 0 ? beside_[static_cast<std::size_t>(t)][3] : tiles_.find(wrapped(at));
        body(at.x * block_width, at.y * block_width, t < 0 ? nullptr : &places_[static_cast<std::size_t>(t)]);
      }
    }
  }

 private:
  static constexpr std::size_t copied_cells = 4;
  struct Copy {
    std::size_t from, to;
  };
  /// The marked cells of a tile: of row i * 4 + j a bit for each.
  using Marks = std::array<std::uint8_t, tile_rows>;
  /// The tiles beside a tile, the one on the low side of an axis before that on the high side.
  using Beside = std::array<std::int32_t, 6>;

  void lay_tiles();
  void mark_in_row(const Vec3i& cell, std::uint8_t bits);
  void lay_copies();
  Vec3i wrapped(Vec3i tile) const {
    for (int a = 0; a < 3; ++a)
      if (period_[a] > 0) tile[a] = ((tile[a] % period_[a]) + period_[a]) % period_[a];
    return tile;
  }

  BlockList tiles_;
  std::vector<Beside> beside_;
  std::vector<Marks> marks_, spread_;
  std::vector<Tile> places_;  ///< of the tiles
  std::vector<Row> rows_;
  std::vector<std::uint32_t> tile_of_row_;
  std::vector<std::uint32_t> outside_;
  std::vector<Vec3i> scratch_;
  std::vector<Copy> copies_;
  Vec3i period_;
  std::size_t row_count_ = 0;
};

/// The place in an array of the first cell of a row.
constexpr std::size_t row_place(std::uint32_t number) { return std::size_t{number} * row_cells; }

/// The places of the first cell of a row and of those beside it, on the low and high side of an
/// axis.
struct RowPlaces {
  std::size_t own, low[3], high[3];
  DM_FN explicit RowPlaces(const CellRows::Row& row)
      : own(row_place(row.number)),
        low{row_place(row.x_low), row_place(row.y_low), own - 1},
        high{row_place(row.x_high), row_place(row.y_high), own + 1} {}
};

}  // namespace dreampm
