// The border between the cpu backend and its kernels: plain pointers, one function per material and
// instruction set.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "dreampm/backend/cpu/arena.h"
#include "dreampm/backend/node_loops.h"
#include "dreampm/backend/pass_limits.h"
#include "dreampm/backend/pass_stats.h"
#include "dreampm/physics/particle.h"

namespace dreampm {

/// The bounds of the particles of a block after a step.
struct BlockExtent {
  Extent extent;
  int wide[2] = {};  ///< vectors whose lanes begin in two rows along this axis, x or y, and in one along the other
};

/// Rows of nodes that are worth fetching while a block is at work. Hints: nothing need lie there.
struct PrefetchHints {
  const std::int32_t* rows;  ///< numbers of their first nodes
  int count;                 ///< number of rows
  std::uintptr_t from;       ///< base of the rows from which the next block gathers, or 0
  std::uintptr_t to;         ///< base of the rows to which this block scatters; their first half is fetched
};

/// The particles of one set in one block, for one pass.
struct BlockPass {
  const void* law;  ///< Law<float> of the kernel's material
  SetStep<float> step;
  BlockWalls<float> walls;
  bool liquid;     ///< true if the set is a liquid, which decides the numbers of the mixture that it feeds
  bool own_field;  ///< true if the set moves in the solids' own field
  // Splines and arenas, from the first node that the block's particles can reach on.
  const float* in;               ///< splines of velocity and mass of the set's field,
  int beside;                    ///< side by side along this axis, of x and y
  Node<float>* out;              ///< momenta and masses, added to
  bool by_volume;                ///< true if a density is measured by the mixture, and not by mass
  const float* mixture_in;       ///< splines of the mixture, or null
  Node<float>* mixture_out;      ///< added to, or null
  const float* velocity_old_in;  ///< splines as in `in` before the forces; null unless the set keeps velocities
  const float* clearance_in;     ///< splines of Obstacles::clearance, or null
  /// Columns of the gradient of the distance from colliders, and of that distance [cells], or null.
  /// Near walls too thin for the splines of the clearance they replace it, where they are below
  /// `no_distance`.
  const float* distance[4];
  Node<float>* velocity_old_out;  ///< as in OldVelocityTerm, added to; null unless the set keeps velocities
  Node<float>* stress_out;        ///< momenta of stress alone, added to; null unless the step to come is sub-cycled
  float* u[3];                    ///< whole columns
  float* own_velocity[3];         ///< velocities that the set keeps, or null
  float* state[most_state_columns];
  std::size_t begin, end;  ///< particles of the block
  PrefetchHints hints;     ///< of the set's field
  LaneGroup* lane_groups;  ///< of its vectors where they are, and after a step where they are then
  float* velocity;         ///< 3 a particle, or null
  float* gradient;         ///< 9 a particle
  float* energy;
  float* volume_ratio;
};

/// Adds what it finds to the stats and to the extent.
using Kernel = void (*)(const BlockPass&, PassStats&, BlockExtent&);

/// The largest square of a speed that the particles gather [m^2/s^2].
using SpeedKernel = float (*)(const BlockPass&);

/// A kernel that adds the momentum of viscous stress to `out`; particles stay as they are. It reads
/// only the members of BlockPass that this takes.
using ViscousKernel = void (*)(const BlockPass&);

/// Work that nothing but the arithmetic units limits: `rounds` rounds of 12 independent
/// multiply-adds in all lanes. Returns their sum, which has to be used.
using MultiplyAdds = float (*)(std::uint64_t rounds);
inline constexpr int multiply_add_chains = 12;

/// The kernels of one instruction set, in the order of the list of materials.
struct KernelTable {
  std::string_view isa;
  int lanes;
  const Kernel* kernels;
  SpeedKernel speed;
  const ViscousKernel* viscous;  ///< null for materials that are not Viscous
  ArenaLoops loops;
  NodeLoops<float> (*node_loops)();
  MultiplyAdds multiply_adds;
};

/// Tables that were built in and that this machine can run, the widest last.
struct KernelTables {
  const KernelTable* tables[4];
  int count;
};
KernelTables available_kernels();

namespace sse4 {
const KernelTable& kernel_table();
}  // namespace sse4
namespace avx2 {
const KernelTable& kernel_table();
}  // namespace avx2
namespace avx512 {
const KernelTable& kernel_table();
}  // namespace avx512
namespace neon {
const KernelTable& kernel_table();
}  // namespace neon

}  // namespace dreampm
