#include "dreampm/solver/projection/cell_rows.h"

#include <algorithm>
#include <atomic>

#include "dreampm/base/narrow.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// Number of rows before the first rows (CellRows::Tile::place_before).
constexpr std::uint32_t rows_outside = 2;
/// Tiles that a thread takes at a time.
constexpr std::size_t tiles_at_once = 64;

constexpr std::size_t row_in_tile(int i, int j) { return static_cast<std::size_t>(i * block_width + j); }

}  // namespace

void CellRows::begin(const std::vector<Vec3i>& blocks, const Vec3i& period) {
  period_ = period;
  scratch_.clear();
  for (const Vec3i& b : blocks)
    if (const Vec3i tile = tile_of_block(b); scratch_.empty() || !(scratch_.back() == tile)) scratch_.push_back(tile);
  // Blocks are in order, and halves of a tile follow one another.
  tiles_.exchange(scratch_);
  lay_tiles();
}

void CellRows::lay_tiles() {
  resize_for_overwrite(beside_, tiles_.size());
  resize_for_overwrite(marks_, tiles_.size());
  parallel_for(tiles_.size(), tiles_at_once, [&](std::size_t t) {
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side) {
        Vec3i other = tiles_[t];
        other[a] += 2 * side - 1;
        beside_[t][static_cast<std::size_t>(2 * a + side)] = tiles_.find(wrapped(other));
      }
    marks_[t] = {};
  });
}

void CellRows::mark(const Vec3i& first, std::uint8_t bits) {
  const int into_row = first.z & (row_cells - 1);
  mark_in_row(first, static_cast<std::uint8_t>(bits << into_row));
  mark_in_row(first + Vec3i{0, 0, row_cells}, static_cast<std::uint8_t>(bits >> (row_cells - into_row)));
}

void CellRows::mark_in_row(const Vec3i& cell, std::uint8_t bits) {
  if (bits == 0) return;
  const std::int32_t t = tiles_.find(wrapped(tile_of_cell(cell)));
  if (t == BlockList::none) return;
  const std::size_t row = row_in_tile(cell.x & (block_width - 1), cell.y & (block_width - 1));
  std::atomic_ref<std::uint8_t> marks(marks_[static_cast<std::size_t>(t)][row]);
  if ((marks.load(std::memory_order_relaxed) & bits) != bits) marks.fetch_or(bits, std::memory_order_relaxed);
}

void CellRows::mark_all() {
  for (Marks& marks : marks_) marks.fill(0xff);
}

void CellRows::spread(Spread to) {
  static constexpr Marks none{};
  resize_for_overwrite(spread_, marks_.size());
  parallel_for(marks_.size(), tiles_at_once, [&](std::size_t t) {
    const auto beside = [&](std::size_t side) -> const Marks& {
      const std::int32_t other = beside_[t][side];
      return other == BlockList::none ? none : marks_[static_cast<std::size_t>(other)];
    };
    const Marks& own = marks_[t];
    const Marks &x_low = beside(0), &y_low = beside(2), &z_low = beside(4);
    constexpr int last = block_width - 1;
    Marks& all = spread_[t];
    for (int i = 0; i < block_width; ++i)
      for (int j = 0; j < block_width; ++j) {
        const std::size_t n = row_in_tile(i, j);
        all[n] = static_cast<std::uint8_t>(own[n] | own[n] << 1 | z_low[n] >> (row_cells - 1) |
                                           (i > 0 ? own[row_in_tile(i - 1, j)] : x_low[row_in_tile(last, j)]) |
                                           (j > 0 ? own[row_in_tile(i, j - 1)] : y_low[row_in_tile(i, last)]));
      }
    if (to == Spread::high) return;
    const Marks &x_high = beside(1), &y_high = beside(3), &z_high = beside(5);
    for (int i = 0; i < block_width; ++i)
      for (int j = 0; j < block_width; ++j) {
        const std::size_t n = row_in_tile(i, j);
        all[n] = static_cast<std::uint8_t>(all[n] | own[n] >> 1 | z_high[n] << (row_cells - 1) |
                                           (i < last ? own[row_in_tile(i + 1, j)] : x_high[row_in_tile(0, j)]) |
                                           (j < last ? own[row_in_tile(i, j + 1)] : y_high[row_in_tile(i, 0)]));
      }
  });
  marks_.swap(spread_);
}

void CellRows::mark_beside(int axis, std::int32_t from, std::int32_t to) {
  const std::int32_t width = axis == 2 ? row_cells : block_width;
  const auto tile_at = [&](std::int32_t cell) { return cell >= 0 ? cell / width : (cell + 1) / width - 1; };
  const std::int32_t source = from - tile_at(from) * width, target = to - tile_at(to) * width;
  const auto side = static_cast<std::size_t>(2 * axis + (to > from ? 1 : 0));
  parallel_for(tiles_.size(), tiles_at_once, [&](std::size_t t) {
    if (tiles_[t][axis] != tile_at(from)) return;
    const std::int32_t other = tile_at(to) == tile_at(from) ? static_cast<std::int32_t>(t) : beside_[t][side];
    if (other == BlockList::none) return;
    const Marks& own = marks_[t];
    Marks& its = marks_[static_cast<std::size_t>(other)];
    if (axis == 2) {
      for (std::size_t n = 0; n < tile_rows; ++n)
        its[n] = static_cast<std::uint8_t>(its[n] | ((own[n] >> source & 1) << target));
    } else {
      for (int n = 0; n < block_width; ++n) {
        const std::size_t before = axis == 0 ? row_in_tile(source, n) : row_in_tile(n, source),
                          behind = axis == 0 ? row_in_tile(target, n) : row_in_tile(n, target);
        its[behind] |= own[before];
      }
    }
  });
}

void CellRows::lay_coarser(const CellRows& fine, std::span<const Row> rows) {
  scratch_.clear();
  for (const Vec3i& t : fine.tiles_.all())
    if (const Vec3i half{t.x >> 1, t.y >> 1, t.z >> 1}; scratch_.empty() || !(scratch_.back() == half))
      scratch_.push_back(half);
  // Not in order, and some come again.
  std::sort(scratch_.begin(), scratch_.end(), block_less);
  scratch_.erase(std::unique(scratch_.begin(), scratch_.end()), scratch_.end());
  tiles_.exchange(scratch_);
  lay_tiles();
  parallel_for(rows.size(), tiles_at_once, [&](std::size_t n) {
    const Vec3i& first = rows[n].first;
    mark({first.x >> 1, first.y >> 1, first.z >> 1}, 1);
  });
  finish();
}

void CellRows::finish() {
  const std::size_t count = tiles_.size();
  resize_for_overwrite(places_, count);
  outside_.clear(), rows_.clear(), tile_of_row_.clear();
  // Each may have a row after it that belongs to no cell.
  narrow<std::uint32_t>(2 * count * tile_rows + rows_outside + 1, "rows of cells");
  std::uint32_t next = 0;
  for (; next < rows_outside; ++next) outside_.push_back(next);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && tiles_[end] == tiles_[end - 1] + Vec3i{0, 0, 1};) ++end;
    for (std::size_t column = 0; column < tile_rows; ++column) {
      const auto end_piece = [&] {
        if (outside_.back() + 1 != next) outside_.push_back(next++);
      };
      const auto i = static_cast<std::int32_t>(column / block_width),
                 j = static_cast<std::int32_t>(column % block_width);
      for (std::size_t t = begin; t < end; ++t) {
        const bool there = marks_[t][column] != 0;
        places_[t].rows[column] = there ? next : outside;
        if (!there) {
          end_piece();
          continue;
        }
        const Vec3i& tile = tiles_[t];
        rows_.push_back({{tile.x * block_width + i, tile.y * block_width + j, tile.z * row_cells}, next++, 0, 0, 0, 0});
        tile_of_row_.push_back(static_cast<std::uint32_t>(t));
      }
      end_piece();
    }
  }
  outside_.push_back(next);
  row_count_ = std::size_t{next} + 1;
  parallel_for(rows_.size(), tiles_at_once * tile_rows, [&](std::size_t n) {
    Row& row = rows_[n];
    const std::size_t t = tile_of_row_[n];
    const int i = row.first.x & (block_width - 1), j = row.first.y & (block_width - 1);
    constexpr int last = block_width - 1;
    const auto row_in = [&](std::int32_t tile, int x, int y) {
      return tile == BlockList::none ? outside : places_[static_cast<std::size_t>(tile)].number(x, y);
    };
    const Tile& own = places_[t];
    const Beside& beside = beside_[t];
    row.x_low = i > 0 ? own.number(i - 1, j) : row_in(beside[0], last, j);
    row.x_high = i < last ? own.number(i + 1, j) : row_in(beside[1], 0, j);
    row.y_low = j > 0 ? own.number(i, j - 1) : row_in(beside[2], i, last);
    row.y_high = j < last ? own.number(i, j + 1) : row_in(beside[3], i, 0);
  });
  lay_copies();
}

void CellRows::lay_copies() {
  copies_.clear();
  if (period_.z == 0) return;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (tiles_[t].z != 0) continue;
    const std::int32_t last = tiles_.find({tiles_[t].x, tiles_[t].y, period_.z - 1});
    if (last == BlockList::none) continue;
    const Tile &low = places_[t], &high = places_[static_cast<std::size_t>(last)];
    for (std::size_t row = 0; row < tile_rows; ++row) {
      if (low.rows[row] == outside || high.rows[row] == outside) continue;
      const std::size_t first = std::size_t{low.rows[row]} * row_cells,
                        end = (std::size_t{high.rows[row]} + 1) * row_cells;
      copies_.push_back({end - copied_cells, first - copied_cells});
      copies_.push_back({first, end});
    }
  }
}

std::uint32_t CellRows::row_of(const Vec3i& cell) const {
  const Tile* const tile = find_tile(cell);
  return tile ? tile->number(cell.x & (block_width - 1), cell.y & (block_width - 1)) : outside;
}

}  // namespace dreampm
