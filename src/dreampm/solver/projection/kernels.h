// The border between the projection and its kernels: loops over plain arrays, compiled once per
// instruction set. Products and sums are not fused, and sums run in one order for any number of
// lanes: all sets give the same bits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "dreampm/math/vec.h"
#include "dreampm/physics/projection/trilinear.h"

namespace dreampm {

/// What is looked up beyond the cells around a block, one particle at a time. Places are in cells
/// from the first of the block's window.
template <class R>
struct Beyond {
  const void* context;
  /// The velocity that moves particles at `x`.
  void (*moving)(const void* context, const R (&x)[3], R (&v)[3]);
  /// Of each component of the velocity the value and its slopes [1/cell].
  void (*slope)(const void* context, const R (&x)[3], R (&found)[3][4]);
  /// Puts a particle out of colliders; null where none is near.
  void (*put_out)(const void* context, R (&x)[3]);
};

/// Where the particles of a block lie, one set's.
template <class R>
struct BlockColumns {
  R *u[3], *own[3], *gradient[9];  ///< whole columns
  std::size_t begin, end;
};

/// Cells of a block's window beyond those that its particles reach where they are: half of a step
/// of two cells, and one.
inline constexpr int reach_ahead = 2;

/// What the particles of one block take from the grid, and where they go.
template <class R>
struct BlockTaking {
  BlockColumns<R> particles;
  const R *velocity[3], *moving[3];  ///< of faces
  const std::size_t* columns;        ///< of Window<reach_ahead>
  R per_cell;                        ///< cells a meter
  R way;                             ///< cells that 1 m/s goes in the step
  Vec3<R> least, most;               ///< where particles are kept [cells from the window's first]
  Vec3<R> kick;                      ///< m/s, of what no known velocity is around
  Beyond<R> beyond;
};

/// How the particles of a block went.
struct BlockMove {
  double fastest2 = 0;  ///< m^2/s^2
  double speed2 = 0;    ///< sum of the squares of velocities [m^2/s^2],
  double slope2 = 0;    ///< and of their gradients [1/s^2]
  bool finite = true;
  bool far = false;  ///< whether any went more than a block
};

/// What the particles of one block give to the grid.
template <class R>
struct BlockGiving {
  BlockColumns<R> particles;
  R dx, volume;                ///< of a particle [cells]
  const std::size_t* columns;  ///< of Window<0>
  FaceSum<R>* sums[3];         ///< of faces, added to
  R* density;                  ///< of cells, added to
  std::uint8_t* held;          ///< of cells: set to 1 where a particle is
};

/// The loops that one instruction set has.
template <class R>
struct ProjectionKernels {
  std::string_view isa;
  void (*take)(const BlockTaking<R>& block, BlockMove& found);
  void (*give)(const BlockGiving<R>& block);
};

/// `isa`: an instruction set of the cpu backend, or "auto" for the widest that the machine has;
/// others, and doubles, have plain loops.
template <class R>
const ProjectionKernels<R>& projection_kernels(std::string_view isa);

namespace sse4 {
const ProjectionKernels<float>& projection_table();
}  // namespace sse4
namespace avx2 {
const ProjectionKernels<float>& projection_table();
}  // namespace avx2
namespace avx512 {
const ProjectionKernels<float>& projection_table();
}  // namespace avx512
namespace neon {
const ProjectionKernels<float>& projection_table();
}  // namespace neon

}  // namespace dreampm
