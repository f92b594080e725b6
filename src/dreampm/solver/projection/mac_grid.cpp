#include "dreampm/solver/projection/mac_grid.h"

#include <algorithm>

#include "dreampm/solver/projection/fill_field.h"
#include "dreampm/state/held_cells.h"
#include "dreampm/state/resize_for_overwrite.h"

namespace dreampm {
namespace {

/// Marks the cells that matter gives enough to be liquid: those that a particle is between.
template <class R>
void mark_matter(const World<R>& world, CellRows& cells) {
  parallel_for(world.particle_blocks.size(), 16, [&](std::size_t b) {
    const std::uint64_t held = held_cells(world, b);
    const Vec3i first = first_stencil(world.particle_blocks[b]);
    for (int i = 0; i <= block_width; ++i)
      for (int j = 0; j <= block_width; ++j) {
        // Bit k: cell k of a column.
        unsigned bits = 0;
        for (int x = std::max(i - 1, 0); x <= std::min(i, block_width - 1); ++x)
          for (int y = std::max(j - 1, 0); y <= std::min(j, block_width - 1); ++y)
            bits |= static_cast<unsigned>(held >> node_index(x, y, 0)) & 0xf;
        cells.mark(first + Vec3i{i, j, 0}, static_cast<std::uint8_t>(bits | bits << 1));
      }
  });
}

/// The number of layers of faces beside liquid to which velocities are extended
/// (extend_velocities).
constexpr int extended_layers = 2;
/// Number of cells from liquid to cut cells that it may fill (find_depths).
constexpr int filled_by_colliders = 4;

}  // namespace

template <class R>
void MacGrid<R>::lay(const World<R>& world) {
  Vec3i period;
  for (int a = 0; a < 3; ++a) {
    const std::int32_t tile = a == 2 ? row_cells : block_width;
    if (world.periodic[static_cast<std::size_t>(a)]) period[a] = (world.high[a] - world.low[a]) / tile;
  }
  low = world.low, high = world.high;
  // Matter that passes an open wall is taken out a box length behind it, when particles are sorted.
  for (int a = 0; a < 3; ++a) {
    const auto side = static_cast<std::size_t>(2 * a);
    const std::int32_t beyond = 2 * (world.high[a] - world.low[a]) + 2 * block_width;
    if (world.walls[side].type == WallType::open) low[a] -= beyond;
    if (world.walls[side + 1].type == WallType::open) high[a] += beyond;
  }
  cells.begin(world.grid.blocks.all(), period);
  mark_matter(world, cells);
  for (int n = 0; n < (world.colliders.empty() ? 0 : filled_by_colliders); ++n) cells.spread(CellRows::Spread::around);
  cells.spread(CellRows::Spread::high);
  for (int n = 0; n < extended_layers; ++n) cells.spread(CellRows::Spread::around);
  // Particles before a wall read behind it.
  for (int a = 0; a < 3; ++a) cells.mark_beside(a, low[a], low[a] - 1), cells.mark_beside(a, high[a] - 1, high[a]);
  cells.finish();
  for (std::size_t w = 0; w < 6; ++w) holding.walls[w] = world.walls[w].type == WallType::stick;
  holding.colliders.clear();
  for (const Collider& c : world.colliders) holding.colliders.push_back(c.contact() == WallType::stick);
  const std::size_t size = cells.size();
  // Sets the cells outside alone where all others are written before they are read.
  const auto lay_outside = [&](Field& field, R value) {
    resize_for_overwrite(field, size);
    cells.fill_outside(field.data(), value);
  };
  for (std::size_t a = 0; a < 3; ++a) {
    fill_field(sums[a], size, FaceSum<R>{});
    lay_outside(open[a], R(0));
    for (Field* f : {&free[a], &velocity[a], &moving[a]}) lay_outside(*f, unknown_velocity<R>);
  }
  for (Field* f : {&density, &impulse, &displacement}) fill_field(*f, size, 0);
  lay_outside(depth, R(-1));
  fill_field(scratch, size, -1);
  fill_field(held, size, 0);
  if (world.colliders.empty())
    room.clear();
  else
    fill_field(room, size, 1);
  const bool solids = !std::all_of(world.sets.begin(), world.sets.end(), is_projected<R>);
  const auto lay_beside = [&](auto& field, auto value) {
    if (solids)
      fill_field(field, size, value);
    else
      field.clear();
  };
  lay_beside(solid_volume, 0);
  for (std::size_t a = 0; a < 3; ++a) {
    lay_beside(solid_sums[a], FaceSum<R>{});
    lay_beside(solid_free[a], unknown_velocity<R>);
    lay_beside(lightness[a], 1);
  }
  for (auto& o : owner)
    if (world.colliders.empty())
      o.clear();
    else
      fill_field(o, size, no_owner);
  const bool holds = std::find(holding.colliders.begin(), holding.colliders.end(), true) != holding.colliders.end();
  for (Field& f : gap)
    if (holds)
      fill_field(f, size, far);
    else
      f.clear();
  const bool moves =
      std::any_of(world.colliders.begin(), world.colliders.end(), [](const Collider& c) { return !c.stands(); });
  for (Field& f : solid)
    if (moves)
      fill_field(f, size, 0);
    else
      f.clear();

  // A face is open between two cells within the walls.
  for_all_rows(cells.rows(), [&](const CellRows::Row& row, const RowPlaces& at) {
    const auto [first, last] = lanes_within(row);
    for (int a = 0; a < 3; ++a) {
      const int begin = a == 2 ? std::max(first, low.z - row.first.z + 1) : row.first[a] == low[a] ? row_cells : first;
      R* const to = open[static_cast<std::size_t>(a)].data() + at.own;
      for (int l = 0; l < row_cells; ++l) to[l] = l >= begin && l < last ? R(1) : R(0);
    }
  });
  for (Field& f : open) wrap(f);
}

template struct MacGrid<float>;
template struct MacGrid<double>;

}  // namespace dreampm
