#include "dreampm/state/world_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dreampm {
namespace {

template <class R>
std::optional<WorldFault> fault_of(const ParticleSet<R>& set, std::size_t blocks) {
  const std::vector<std::uint32_t>& start = set.block_start;
  const std::string name = "set/" + set.name + "/";
  if (start.size() != blocks + 1 || start.front() != 0 || start.back() != set.size() ||
      !std::is_sorted(start.begin(), start.end()))
    return WorldFault{name + "block_start",
                      fmt::format("it does not share {} particles among {} blocks", set.size(), blocks)};
  for (std::size_t a = 0; a < set.u.size(); ++a)
    for (const R u : set.u[a])
      if (!(u > R(-1) && u < R(block_width + 1)))  // what they may be until the next sort
        return WorldFault{fmt::format("{}u{}", name, a),
                          fmt::format("a particle is {} cells from where its block begins", u)};
  return std::nullopt;
}

/// True if the grid has all blocks that particles of a block reach.
template <class R>
bool has_around(const World<R>& world, const Vec3i& block) {
  for (int corner = 0; corner < 8; ++corner)
    if (world.grid.blocks.find(world.wrapped(block + Vec3i{corner >> 2, corner >> 1 & 1, corner & 1})) ==
        BlockList::none)
      return false;
  return true;
}

}  // namespace

std::optional<std::string> find_fault(const std::vector<Vec3i>& blocks) {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max() / (4 * block_width);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (i > 0 && !block_less(blocks[i - 1], blocks[i])) return "its blocks are not in order";
    for (int a = 0; a < 3; ++a)
      if (blocks[i][a] < -most || blocks[i][a] > most) return fmt::format("a block is at {}", blocks[i][a]);
  }
  return std::nullopt;
}

template <class R>
std::optional<WorldFault> find_fault(const World<R>& world) {
  for (const double number : {world.time, world.dt_next, world.drift, world.wave_speed, world.viscosity})
    if (!std::isfinite(number)) return WorldFault{"clock", fmt::format("it holds {}", number)};
  const std::vector<Vec3i>& blocks = world.particle_blocks;
  if (const auto why = find_fault(blocks)) return WorldFault{"particle_blocks", *why};
  if (const auto why = find_fault(world.grid.blocks.all())) return WorldFault{"grid/blocks", *why};
  for (const ParticleSet<R>& set : world.sets)
    if (set.size() > 0)
      if (auto fault = fault_of(set, blocks.size())) return fault;
  if (!world.cell_pressure.empty() && world.cell_pressure.size() != world.grid.blocks.size() * block_nodes)
    return WorldFault{"cell_pressure", fmt::format("it holds {} numbers for {} blocks of the grid",
                                                   world.cell_pressure.size(), world.grid.blocks.size())};
  for (const Vec3i& block : blocks)
    if (!has_around(world, block))
      return WorldFault{"grid/blocks", fmt::format("particles in block ({}, {}, {}) reach one that is not there",
                                                   block.x, block.y, block.z)};
  return std::nullopt;
}

template std::optional<WorldFault> find_fault(const World<float>&);
template std::optional<WorldFault> find_fault(const World<double>&);

}  // namespace dreampm
