#include "dreampm/state/grid_topology.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/state/resize_for_overwrite.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {
namespace {

/// Calls body(field of a, field of b, whether the world wants it) for all fields of two grids, of
/// which one is the world's.
template <class R, class Body>
void for_fields(const World<R>& world, GridFields<R>& a, GridFields<R>& b, const Body& body) {
  visit_nodes(a, b, [&]<class F>(const F& field, auto& its, auto& other) {
    const auto& present = &a == &world.grid ? its : other;
    body(its, other, goes_on(field, world, present));
  });
}

/// The blocks around a block that lie on a side of it (-1 to 2) along an axis, as HaloMask::around.
struct Sides {
  std::uint64_t around[3][4]{};
  constexpr Sides() {
    for (int axis = 0; axis < 3; ++axis)
      for (int bit = 0; bit < 64; ++bit) around[axis][halo_offset(bit)[axis] + 1] |= std::uint64_t{1} << bit;
  }
  constexpr std::uint64_t on(int axis, int side) const { return around[axis][side + 1]; }
};
constexpr Sides sides;

/// The blocks around a block that its particles can reach before the next sort, by the cell in
/// which they are now.
class CellReach {
 public:
  template <class R>
  CellReach(const World<R>& world, const Vec3i& block) {
    for (int a = 0; a < 3; ++a) {
      std::uint64_t all = 0;
      for (int c = 0; c < block_width; ++c) {
        // They move less than a cell, and a cell's stencil has three nodes. Who reaches a wall
        // reaches behind it too: the images there weigh on the wall's own nodes.
        int first = first_stencil(block)[a] + c - 1, last = first + 4;
        const bool walled = !world.periodic[static_cast<std::size_t>(a)];
        if (walled && first == world.low[a]) --first;
        if (walled && last == world.high[a]) ++last;
        sides_[a][c] = 0;
        for (int side = (first >> 2) - block[a]; side <= (last >> 2) - block[a]; ++side)
          sides_[a][c] |= sides.on(a, side);
        all |= sides_[a][c];
      }
      all_ &= all;
    }
  }
  /// Returns the blocks that particles in `cells` reach.
  std::uint64_t of(std::uint64_t cells) const {
    std::uint64_t around = 0;
    for (; cells && around != all_; cells &= cells - 1) {
      const Vec3i at = node_offset(std::countr_zero(cells));
      around |= sides_[0][at.x] & sides_[1][at.y] & sides_[2][at.z];
    }
    return around;
  }

 private:
  std::uint64_t sides_[3][block_width];
  std::uint64_t all_ = ~std::uint64_t{0};  ///< what particles in all cells reach
};

}  // namespace

template <class R>
bool GridTopology<R>::lay(World<R>& world, std::span<const std::uint64_t> cells) {
  const std::vector<Vec3i>& blocks = world.particle_blocks;
  resize_for_overwrite(halos_, blocks.size());
  parallel_for(halos_.size(), 64,
               [&](std::size_t b) { halos_[b] = {blocks[b], CellReach(world, blocks[b]).of(cells[b])}; });
  std::vector<Vec3i>& wanted = halo_union_(world, halos_);
  GridFields<R>& grid = world.grid;
  const std::size_t nodes = wanted.size() * block_nodes;
  bool same = wanted == grid.blocks.all();
  for_fields(world, grid, grid,
             [&](auto& field, auto&, bool needed) { same = same && field.size() == (needed ? nodes : 0); });
  if (same) return false;
  std::swap(blocks_, grid.blocks);
  grid.blocks.exchange(wanted);
  return true;
}

template <class R>
void GridTopology<R>::find_before(const World<R>& world, std::vector<std::int32_t>& before) const {
  const BlockList& now = world.grid.blocks;
  resize_for_overwrite(before, now.size());
  parallel_ranges(now.size(), 128, [&](std::size_t begin, std::size_t end) {
    std::size_t old = begin < end ? blocks_.first_from(now[begin]) : 0;
    for (std::size_t b = begin; b < end; ++b) {
      while (old < blocks_.size() && block_less(blocks_[old], now[b])) ++old;
      const bool carried = old < blocks_.size() && blocks_[old] == now[b];
      before[b] = carried ? static_cast<std::int32_t>(old) : BlockList::none;
    }
  });
}

template <class R>
void GridTopology<R>::operator()(World<R>& world, std::span<const std::uint64_t> cells, GridFields<R>& spare) {
  if (lay(world, cells)) carry(world, spare);
}

template <class R>
void GridTopology<R>::carry(World<R>& world, GridFields<R>& spare) {
  GridFields<R>& grid = world.grid;
  const std::size_t nodes = grid.blocks.size() * block_nodes;
  find_before(world, before_);
  for_fields(world, spare, grid,
             [&](auto& field, auto&, bool needed) { resize_for_overwrite(field, needed ? nodes : 0); });
  parallel_ranges(grid.blocks.size(), 128, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      for_fields(world, spare, grid, [&](auto& to, auto& from, bool needed) {
        if (!needed) return;
        const auto target = to.begin() + static_cast<std::ptrdiff_t>(b * block_nodes);
        if (before_[b] != BlockList::none && !from.empty())
          std::copy_n(from.begin() + std::ptrdiff_t{before_[b]} * block_nodes, block_nodes, target);
        else
          std::fill_n(target, block_nodes, typename std::remove_reference_t<decltype(to)>::value_type{});
      });
  });
  for_fields(world, spare, grid, [&](auto& a, auto& b, bool) {
    a.swap(b);
    resize_for_overwrite(a, b.size());
  });
}

template class GridTopology<float>;
template class GridTopology<double>;

}  // namespace dreampm
