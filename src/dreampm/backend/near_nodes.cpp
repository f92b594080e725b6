#include "dreampm/backend/near_nodes.h"

#include <algorithm>
#include <cmath>

#include "dreampm/math/four.h"

namespace dreampm {
namespace {

constexpr float far_away = 1e6f;  // cells

/// The bit of the side that a gradient is turned like, by more than rounding: that of a mean of
/// such is turned the same. None where there is no slope, and all where it is not clear.
std::uint8_t side_bit(const Node<float>& gradient) {
  constexpr float clear = 1.001f;
  const float x = std::abs(gradient.x), y = std::abs(gradient.y), z = std::abs(gradient.z);
  if (x == 0 && y == 0 && z == 0) return 0;
  if (x > clear * y && x > clear * z) return gradient.x < 0 ? 2 : 1;
  if (y > clear * x && y > clear * z) return gradient.y < 0 ? 8 : 4;
  if (z > clear * x && z > clear * y) return gradient.z < 0 ? 32 : 16;
  return NearNodes::all_sides;
}
/// All bits of each and of the two that follow at `step`; behind the last it stays as it is.
template <std::size_t nodes>
void any_of_three(std::array<std::uint8_t, nodes>& bits, std::size_t step) {
  for (std::size_t i = 0; i < nodes - 2 * step; ++i)
    bits[i] = static_cast<std::uint8_t>(bits[i] | bits[i + step] | bits[i + 2 * step]);
}

}  // namespace

void NearNodes::find(const StencilBlocks& blocks, const Obstacles& obstacles) {
  for (int i = 0; i < width; ++i)
    for (int j = 0; j < width; ++j)
      for (int k = 0; k < width; k += block_width) {
        const Vec3i at{i, j, k};
        const std::int32_t block = blocks[reached_at(at)];
        float* const to = distance.data() + index(at);
        const Node<float>* const from =
            block == BlockList::none
                ? nullptr
                : obstacles.clearance().data() + static_cast<std::size_t>(block) * block_nodes + node_at(at);
        std::uint8_t* const side = sides.data() + index(at);
        for (int n = 0; n < block_width; ++n) {
          to[n] = from ? from[n].m : far_away;
          side[n] = from ? side_bit(from[n]) : all_sides;
        }
      }
  std::fill(distance.begin() + size, distance.end(), far_away);
  std::array<float, size> other;
  least_of_three(distance.data(), least, width * width);
  least_of_three(least.data(), other, width);
  least_of_three(other.data(), least, 1);
  nearest = *std::min_element(least.begin(), least.end());
  for (const std::size_t step : {width * width, width, 1}) any_of_three(sides, step);
}

/// The mean over a stencil that begins at `first`; sums of rows first, so it is rounded otherwise
/// than in the order of the nodes.
template <class R>
R NearNodes::distance_at(const Vec3i& first, const Stencil<R>& stencil) const {
  const float* const from = distance.data() + index(first);
  Four<R> rows{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const R weight = stencil.w[0][i] * stencil.w[1][j];
      Four<R> row;
      load_floats<R>(from + (i * width + j) * width, row);
      rows += row * weight;
    }
  return rows[0] * stencil.w[2][0] + rows[1] * stencil.w[2][1] + rows[2] * stencil.w[2][2];
}

template float NearNodes::distance_at(const Vec3i&, const Stencil<float>&) const;
template double NearNodes::distance_at(const Vec3i&, const Stencil<double>&) const;

}  // namespace dreampm
