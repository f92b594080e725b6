#include "dreampm/state/lay_grid.h"

#include <algorithm>
#include <utility>

#include "dreampm/base/parallel.h"
#include "dreampm/state/refit.h"

namespace dreampm {
namespace {

/// Calls body(field of a, field of b, whether the world wants it) for all fields of two grids.
template <class R, class Body>
void for_fields(const World<R>& world, Carried<R>& a, Carried<R>& b, const Body& body) {
  body(a.nodes, b.nodes, true);
  body(a.solids, b.solids, world.needs_solid_field());
  body(a.liquid, b.liquid, world.needs_liquid_channel());
  for (std::size_t f = 0; f < 2; ++f) body(a.before[f], b.before[f], world.keeps_velocities(f));
}

}  // namespace

template <class R>
void LayGrid<R>::operator()(World<R>& world, Carried<R>& spare) {
  reach_.clear();
  for (const Vec3i& b : world.particle_blocks) reach_.push_back({b, all_around});
  std::vector<Vec3i>& wanted = spread_(world, reach_);
  Carried<R>& grid = world.grid;
  const std::size_t nodes = wanted.size() * block_nodes;

  bool same = wanted == grid.blocks.all();
  for_fields(world, grid, spare,
             [&](auto& field, auto&, bool needed) { same = same && field.size() == (needed ? nodes : 0); });
  if (same) return;

  std::swap(blocks_, grid.blocks);
  grid.blocks.exchange(wanted);
  for_fields(world, spare, grid, [&](auto& field, auto&, bool needed) { refit(field, needed ? nodes : 0); });
  parallel_ranges(grid.blocks.size(), 128, [&](std::size_t begin, std::size_t end) {
    std::size_t old = begin < end ? blocks_.first_from(grid.blocks[begin]) : 0;
    for (std::size_t b = begin; b < end; ++b) {
      while (old < blocks_.size() && before(blocks_[old], grid.blocks[b])) ++old;
      const bool carried = old < blocks_.size() && blocks_[old] == grid.blocks[b];
      for_fields(world, spare, grid, [&](auto& to, auto& from, bool needed) {
        if (!needed) return;
        const auto target = to.begin() + static_cast<std::ptrdiff_t>(b * block_nodes);
        if (carried && !from.empty())
          std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(old * block_nodes), block_nodes, target);
        else
          std::fill_n(target, block_nodes, typename std::remove_reference_t<decltype(to)>::value_type{});
      });
    }
  });
  for_fields(world, spare, grid, [&](auto& a, auto& b, bool) {
    a.swap(b);
    refit(a, b.size());
  });
}

template class LayGrid<float>;
template class LayGrid<double>;

}  // namespace dreampm
