#include "dreampm/solver/projection/cell_rows.h"

#include <algorithm>

#include "dreampm/base/narrow.h"
#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// Before the first run (CellRows::Tile::place_before).
constexpr std::size_t rows_outside = 2;

}  // namespace

void CellRows::lay(const std::vector<Vec3i>& blocks, const Vec3i& period) {
  period_ = period;
  scratch_.clear();
  for (const Vec3i& b : blocks)
    if (const Vec3i tile = tile_of_block(b); scratch_.empty() || !(scratch_.back() == tile)) scratch_.push_back(tile);
  // Blocks are in order, and halves of a tile follow one another.
  tiles_.exchange(scratch_);
  lay_tiles();
  lay_copies();
}

void CellRows::lay_coarser(const CellRows& fine) {
  scratch_.clear();
  for (const Vec3i& t : fine.tiles_.all())
    if (const Vec3i half{t.x >> 1, t.y >> 1, t.z >> 1}; scratch_.empty() || !(scratch_.back() == half))
      scratch_.push_back(half);
  // Not in order, and some come again.
  std::sort(scratch_.begin(), scratch_.end(), block_less);
  scratch_.erase(std::unique(scratch_.begin(), scratch_.end()), scratch_.end());
  tiles_.exchange(scratch_);
  lay_tiles();
}

void CellRows::lay_tiles() {
  const std::size_t count = tiles_.size();
  resize_for_overwrite(places_, count);
  std::size_t next = rows_outside;
  outside_.clear();
  for (std::uint32_t row = 0; row < rows_outside; ++row) outside_.push_back(row);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && tiles_[end] == tiles_[end - 1] + Vec3i{0, 0, 1};) ++end;
    const std::size_t length = end - begin;
    for (std::size_t t = begin; t < end; ++t)
      places_[t] = {narrow<std::uint32_t>(next + 1 + (t - begin), "rows of cells"),
                    static_cast<std::uint32_t>(length + 1)};
    for (std::size_t column = 0; column <= tile_rows; ++column)
      outside_.push_back(static_cast<std::uint32_t>(next + column * (length + 1)));
    next += tile_rows * (length + 1) + 1;
  }
  outside_.push_back(narrow<std::uint32_t>(next, "rows of cells"));
  row_count_ = next + 1;

  resize_for_overwrite(rows_, count * tile_rows);
  // Of each run its place among the rows: all of its first column come first.
  std::size_t done = 0;
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t length = places_[begin].stride - 1;
    parallel_for(length, 64, [&](std::size_t n) {
      const std::size_t t = begin + n;
      const Vec3i tile = tiles_[t];
      std::int32_t beside[4];
      const Vec3i ways[4] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
      for (int w = 0; w < 4; ++w) beside[w] = tiles_.find(wrapped(tile + ways[w]));
      const auto row_in = [&](std::int32_t other, int i, int j) {
        if (other == BlockList::none) return outside;
        return places_[static_cast<std::size_t>(other)].number(i, j);
      };
      const auto own = static_cast<std::int32_t>(t);
      constexpr int last = block_width - 1;
      for (int i = 0; i < block_width; ++i)
        for (int j = 0; j < block_width; ++j)
          rows_[done + static_cast<std::size_t>(i * block_width + j) * length + n] = {
              {tile.x * block_width + i, tile.y * block_width + j, tile.z * row_cells},
              row_in(own, i, j),
              i > 0 ? row_in(own, i - 1, j) : row_in(beside[0], last, j),
              i < last ? row_in(own, i + 1, j) : row_in(beside[1], 0, j),
              j > 0 ? row_in(own, i, j - 1) : row_in(beside[2], i, last),
              j < last ? row_in(own, i, j + 1) : row_in(beside[3], i, 0)};
    });
    begin += length, done += length * tile_rows;
  }
}

void CellRows::lay_copies() {
  copies_.clear();
  if (period_.z == 0) return;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    if (tiles_[t].z != 0) continue;
    const std::int32_t last = tiles_.find({tiles_[t].x, tiles_[t].y, period_.z - 1});
    if (last == BlockList::none) continue;
    const Tile &low = places_[t], &high = places_[static_cast<std::size_t>(last)];
    for (int i = 0; i < block_width; ++i)
      for (int j = 0; j < block_width; ++j) {
        const std::size_t first = std::size_t{low.number(i, j)} * row_cells,
                          end = (std::size_t{high.number(i, j)} + 1) * row_cells;
        copies_.push_back({end - copied_cells, first - copied_cells});
        copies_.push_back({first, end});
      }
  }
}

std::uint32_t CellRows::row_of(const Vec3i& cell) const { return tile_of(cell).number(cell.x & 3, cell.y & 3); }

}  // namespace dreampm
