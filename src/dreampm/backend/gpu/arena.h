// The nodes that the particles of one block reach, in a device's memory: 8^3 of them, two blocks of
// the grid along each axis. Particles add to whole numbers in place of floats: these have no order,
// so that the sums are the same whichever thread comes first, and multiprocessors add them at full
// rate.
#pragma once
#include <cstdint>

#include "dreampm/math/scalar.h"
#include "dreampm/state/node.h"

namespace dreampm::gpu {

inline constexpr int arena_width = 2 * block_width;
inline constexpr int arena_nodes = arena_width * arena_width * arena_width;
/// Shared memory has 32 banks. Rows lie 8 words apart and planes 68, so that the bank of a
/// stencil's first node is the bank of all 27 but for one shift: threads whose stencils begin in 32
/// different banks never wait for each other.
inline constexpr int arena_plane = 68, arena_room = arena_width * arena_plane;

/// The place of a node in the memory of a block of threads; coordinates from 0 to 7.
constexpr int place_in_arena(int x, int y, int z) { return x * arena_plane + y * arena_width + z; }

/// A node of an arena by number, as arenas lie in memory.
struct ArenaNode {
  int x, y, z;
  explicit DM_FN ArenaNode(int n)
      : x(n / (arena_width * arena_width)), y(n / arena_width % arena_width), z(n % arena_width) {}
  DM_FN int place() const { return place_in_arena(x, y, z); }
  /// Which of the eight blocks of the grid holds it, and its number there.
  DM_FN int corner() const { return (x / block_width * 2 + y / block_width) * 2 + z / block_width; }
  DM_FN int in_block() const { return node_index(x % block_width, y % block_width, z % block_width); }
};
/// The number of node `n` of corner block `corner` in the arena.
DM_FN int number_in_arena(int corner, int n) {
  const int x = corner / 4 * block_width + n / (block_width * block_width),
            y = corner / 2 % 2 * block_width + n / block_width % block_width,
            z = corner % 2 * block_width + n % block_width;
  return (x * arena_width + y) * arena_width + z;
}

/// Sums at a node, in units of ScatterUnits.
struct alignas(16) NodeCounts {
  std::int32_t x, y, z, m;
};

/// Sums that go on at the other end of the range: of a pass that has to be done again.
DM_FN std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
DM_FN NodeCounts operator+(const NodeCounts& a, const NodeCounts& b) {
  return {wrapped_sum(a.x, b.x), wrapped_sum(a.y, b.y), wrapped_sum(a.z, b.z), wrapped_sum(a.m, b.m)};
}
DM_FN NodeCounts operator-(const NodeCounts& a) {
  const auto less = [](std::int32_t n) { return static_cast<std::int32_t>(0 - static_cast<std::uint32_t>(n)); };
  return {less(a.x), less(a.y), less(a.z), less(a.m)};
}

/// What all sets of a block may put on one node at most, per field: mass [kg] and rest volume over
/// dx^3 [1]. No weight is above 0.75^3; and it is no less than one particle's whole, which is
/// counted before it is spread.
struct BlockLoad {
  float mass[2], volume;
};
inline constexpr double largest_weight = 0.75 * 0.75 * 0.75;

/// Bounds of what particles scatter in a pass.
struct ScatterBounds {
  float speed;         ///< m/s: largest momentum at a node of the stencil over the mass, along an axis
  float mass;          ///< kg: most at a node of an arena
  float volume_ratio;  ///< of solids
  float viscosity;     ///< m^2/s
};

/// How many counts are 1 kg m/s and so on: powers of two, so that no digit is lost to the scale.
struct ScatterUnits {
  float momentum, mass;
};
/// The largest power of two whose product with `most` is below 2^30; `most` >= 0.
DM_FN float counts_per_unit(float most) { return exp2_int(29.0f - exponent_of(max(most, 1e-25f))); }
/// What one count is: the reciprocal of such a power of two, exactly.
DM_FN double per_count(float counts) { return static_cast<double>(exp2_int(-exponent_of(counts))); }
/// The larger of each.
DM_FN ScatterBounds largest(const ScatterBounds& a, const ScatterBounds& b) {
  return {max(a.speed, b.speed), max(a.mass, b.mass), max(a.volume_ratio, b.volume_ratio),
          max(a.viscosity, b.viscosity)};
}
/// True if nothing that was found is beyond what was assumed.
DM_FN bool within(const ScatterBounds& found, const ScatterBounds& assumed) {
  return !(found.speed > assumed.speed) && !(found.mass > assumed.mass) &&
         !(found.volume_ratio > assumed.volume_ratio) && !(found.viscosity > assumed.viscosity);
}

/// As much more than the last pass did a pass may give to its nodes before it has to be done again.
DM_FN ScatterBounds widened(const ScatterBounds& b) {
  constexpr float margin = 1.5f;
  return {margin * b.speed, margin * b.mass, margin * b.volume_ratio, margin * b.viscosity};
}

/// Units of momentum and mass of a field.
DM_FN ScatterUnits field_units(const BlockLoad& load, int field, const ScatterBounds& bounds) {
  const float most = min(load.mass[field], bounds.mass);
  return {counts_per_unit(most * bounds.speed), counts_per_unit(most)};
}
/// Units of the mixture: of volumes, in place of a momentum, and of viscosity times mass.
DM_FN ScatterUnits mixture_units(const BlockLoad& load, const ScatterBounds& bounds) {
  return {counts_per_unit(load.volume * max(bounds.volume_ratio, 1.0f)),
          counts_per_unit(min(load.mass[0], bounds.mass) * bounds.viscosity)};
}

}  // namespace dreampm::gpu
