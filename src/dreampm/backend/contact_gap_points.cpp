// The gaps before points of the colliders' surfaces.
#include <algorithm>

#include "dreampm/backend/contact_gap.h"
#include "dreampm/backend/wall_distance.h"

namespace dreampm {
namespace {

constexpr float far_away = ContactGaps::none;

}  // namespace

ContactGaps::AtPoints::AtPoints(const ContactGaps& gaps, const Neighbors& around) : gaps_(gaps) {
  for (std::size_t n = 0; n < slots_.size(); ++n) {
    slots_[n] = around[n] == BlockList::none ? -1 : gaps_.gaps_of_[static_cast<std::size_t>(around[n])];
    if (slots_[n] < 0) continue;
    const auto& any = gaps_.cell_gaps_[static_cast<std::size_t>(slots_[n])].any;
    for (std::size_t side = 0; side < 6; ++side) any_[side] |= any[side];
  }
}

void ContactGaps::AtPoints::find_smallest(int side) {
  // Two nodes more than stencils begin at, and one so that rows are eight long.
  constexpr int all = width + 2, row = 8;
  known_[static_cast<std::size_t>(side)] = true;
  std::array<const float*, 27> blocks;
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n] = gaps_.gaps_at(slots_[n], side).data();
  std::array<float, all * all * row> a, b;
  for (int i = 0; i < all; ++i)
    for (int j = 0; j < all; ++j) {
      // From the second node before the block on: two of the block before, its own, one after.
      const float* const* const along = blocks.data() + ((i + 2) >> 2) * 9 + ((j + 2) >> 2) * 3;
      const int first = node_index((i + 2) & 3, (j + 2) & 3, 0);
      float* const to = a.data() + (i * all + j) * row;
      std::copy_n(along[0] + first + 2, 2, to);
      std::copy_n(along[1] + first, 4, to + 2);
      to[6] = along[2][first], to[7] = far_away;
    }
  const auto least = [](const float* from, int step, float* to) {
    for (int k = 0; k < row; ++k) {
      const float first = from[k + step] < from[k] ? from[k + step] : from[k];
      to[k] = from[k + 2 * step] < first ? from[k + 2 * step] : first;
    }
  };
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < all; ++j) least(a.data() + (i * all + j) * row, all * row, b.data() + (i * all + j) * row);
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < width; ++j) {
      std::array<float, row> rows;
      least(b.data() + (i * all + j) * row, row, rows.data());
      float* const to = smallest_[static_cast<std::size_t>(side)].data() + (i * width + j) * width;
      for (std::size_t k = 0; k < width; ++k) to[k] = std::min({rows[k], rows[k + 1], rows[k + 2]});
    }
}

float ContactGaps::AtPoints::at(const SurfacePoint& point) {
  float gap = far_away;
  for (int side = 0; side < 6; ++side) {
    if (any_[static_cast<std::size_t>(side)] == 0 || !turned_like(point.normal, side)) continue;
    if (!known_[static_cast<std::size_t>(side)]) find_smallest(side);
    const int i = point.first[0] + 1, j = point.first[1] + 1, k = point.first[2] + 1;
    gap =
        std::min(gap, smallest_[static_cast<std::size_t>(side)][static_cast<std::size_t>((i * width + j) * width + k)]);
  }
  return gap;
}

}  // namespace dreampm
