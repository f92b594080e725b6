// The cells of a projection: tiles of 4 x 4 x 8 cells where there is matter, in rows of eight along
// z. A cell has the coordinates of its node of lowest coordinates, and so has the face of each axis
// on its low side.
#pragma once
#include <algorithm>
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

/// Where each row of cells lies in the arrays of a grid. Tiles that follow one another along z are
/// a run: their rows are one piece of memory, with a row before and after that belongs to no cell,
/// so that the neighbors of a cell along z are those beside it in memory. Values of rows that
/// belong to no cell stand for all that is outside.
class CellRows {
 public:
  struct Row {
    Vec3i first;                                 ///< its first cell
    std::uint32_t number;                        ///< its cells are [8 number, 8 number + 8) of an array
    std::uint32_t x_low, x_high, y_low, y_high;  ///< the rows beside it; `outside` where there is none
  };
  /// A row that belongs to no cell; so does the next one.
  static constexpr std::uint32_t outside = 0;

  /// `blocks`: of the grid, in order. `period`: tiles between the two ends of an axis that meet,
  /// where tile 0 is the first; 0 of other axes. Keeps its memory.
  void lay(const std::vector<Vec3i>& blocks, const Vec3i& period = {});
  /// The rows of a level that is half as fine: a cell of it is two by two by two of `fine`.
  void lay_coarser(const CellRows& fine);

  /// The length of an array over all rows.
  std::size_t size() const { return row_count_ * row_cells; }
  /// In the order of their memory.
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

  /// A tile by its rows: row (i, j) is number `row` + (i * 4 + j) * `stride`.
  struct Tile {
    std::uint32_t row = outside;
    std::uint32_t stride = 0;  ///< the length of its run and one; 0 where the tile is not there
    std::uint32_t number(int i, int j) const { return row + static_cast<std::uint32_t>(i * block_width + j) * stride; }
    /// The place in an array of a cell that lies `before` cells before row (i, j), up to eight,
    /// along z: cells from there to the eighth after that row are beside one another. One from
    /// which sixteen belong to no cell where the tile is not there.
    std::size_t place_before(int i, int j, std::size_t before) const {
      return stride == 0 ? 0 : std::size_t{number(i, j)} * row_cells - before;
    }
  };
  /// Calls body(n, place) for the 64 cells of a block, n by node_index(), whose tile is there.
  template <class Body>
  void for_block(const Vec3i& block, const Body& body) const {
    const Tile tile = tile_of(block * block_width);
    if (tile.stride == 0) return;
    for (int n = 0; n < block_nodes; ++n) {
      const Vec3i at = node_offset(n);
      body(static_cast<std::size_t>(n), std::size_t{tile.number(at.x, at.y)} * row_cells +
                                            static_cast<std::size_t>((block.z & 1) * block_width + at.z));
    }
  }
  /// The tile that a cell is in.
  Tile tile_of(const Vec3i& cell) const {
    const std::int32_t t = tiles_.find(wrapped(tile_of_cell(cell)));
    return t == BlockList::none ? Tile{} : places_[static_cast<std::size_t>(t)];
  }

 private:
  static constexpr std::size_t copied_cells = 4;
  struct Copy {
    std::size_t from, to;
  };
  void lay_tiles();
  void lay_copies();
  Vec3i wrapped(Vec3i tile) const {
    for (int a = 0; a < 3; ++a)
      if (period_[a] > 0) tile[a] = ((tile[a] % period_[a]) + period_[a]) % period_[a];
    return tile;
  }

  BlockList tiles_;
  std::vector<Tile> places_;  ///< of the tiles
  std::vector<Row> rows_;
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
