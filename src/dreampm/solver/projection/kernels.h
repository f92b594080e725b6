// The border between the projection and its kernels: loops over plain arrays, compiled once per
// instruction set. Products and sums are not fused, and sums run in one order for any number of
// lanes: all sets give the same bits.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "dreampm/math/vec.h"
#include "dreampm/physics/projection/trilinear.h"
#include "dreampm/solver/projection/cell_rows.h"

namespace dreampm {

/// Functions that look up values beyond the cells around a block, one particle at a time. Places
/// are in cells from the first of the block's window.
template <class R>
struct Beyond {
  const void* context;
  /// The velocity that moves particles at `x`.
  void (*moving)(const void* context, const R (&x)[3], R (&v)[3]);
  /// Finds each component of the velocity, and its slopes [1/cell].
  void (*slope)(const void* context, const R (&x)[3], R (&found)[3][4]);
  /// Puts a particle that came from `start` out of colliders, by its number among those of its set;
  /// returns the energy that it loses [J]. Null where no collider is near.
  double (*put_out)(const void* context, std::size_t particle, const R (&start)[3], R (&x)[3]);
};

/// The columns of the particles of a block, one set's; T: R, or const R where they stay as they
/// are.
template <class T>
struct BlockColumns {
  T *u[3], *own_velocity[3], *gradient[9];  ///< whole columns
  std::size_t begin, end;
};

/// Cells of a block's window beyond those that its particles reach where they are: half of a step
/// of two cells, and one.
inline constexpr int reach_ahead = 2;

/// Input and output of the loop in which the particles of one block take from the grid and move.
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

/// Statistics of the motion of the particles of a block.
struct BlockMove {
  double fastest2 = 0;  ///< m^2/s^2
  double speed2 = 0;    ///< sum of the squares of velocities [m^2/s^2]
  double slope2 = 0;    ///< sum of the squares of velocity gradients [1/s^2]
  double lost = 0;      ///< J, at colliders
  bool finite = true;
  bool far = false;  ///< true if any went more than a block

  void add(const BlockMove& b) {
    fastest2 = b.fastest2 > fastest2 ? b.fastest2 : fastest2;
    speed2 += b.speed2, slope2 += b.slope2, lost += b.lost;
    finite = finite && b.finite, far = far || b.far;
  }
};

/// Input and output of the loop in which the particles of one block give to the grid.
template <class R>
struct BlockGiving {
  BlockColumns<const R> particles;
  R dx, volume;                ///< of a particle [cells]
  const std::size_t* columns;  ///< of Window<0>
  FaceSum<R>* sums[3];         ///< of faces, added to
  R* density;                  ///< of cells, added to
  std::uint8_t* held;          ///< of cells: set to 1 where a particle is
};

/// Stands for the velocity of a face that nothing is known of. What is interpolated with one is as
/// large, and so unknown too.
template <class R>
inline constexpr R unknown_velocity = R(1e30);
/// Velocities beyond are unknown.
template <class R>
inline constexpr R most_known = R(1e10);
template <class R>
constexpr bool is_known(R v) {
  return v < most_known<R> && v > -most_known<R>;
}

/// Fields of a MacGrid as loops over rows see them; null where they are empty.
template <class R>
struct GridRows {
  const CellRows::Row* rows;
  Vec3i low, high;
  const FaceSum<R>* sums[3];
  const R *open[3], *solid[3], *lightness[3];
  const R *depth, *impulse;
  R *free[3], *velocity[3], *moving[3];
};

/// The matrix of the pressure, to be filled.
template <class R>
struct MatrixRows {
  R *diagonal, *low[3], *b;
};

/// Sums over the faces of some rows, each by the particles of liquid that it has.
struct EnergySums {
  double given = 0;      ///< u^2/2 [m^2/s^2] as scattered from particles
  double projected = 0;  ///< u^2/2 [m^2/s^2] after the pressure
  /// The loss between them: the velocity that a face lacks beside that by gravity, times the mean
  /// of its speeds before and after [m^2/s^2].
  double lost = 0;
  void add(const EnergySums& b) { given += b.given, projected += b.projected, lost += b.lost; }
};

/// Loops over the rows [begin, end) of a grid, for the functions of pressure.h.
template <class R>
struct RowKernels {
  using Grid = GridRows<R>;
  /// `free` from `sums` and what gravity gives; less than the weight `least` reaches no face.
  void (*free_velocities)(Grid grid, std::size_t begin, std::size_t end, const Vec3<R>& kick, R least);
  /// fill_matrix, of rows with liquid.
  void (*matrix)(Grid grid, std::size_t begin, std::size_t end, const MatrixRows<R>& to);
  /// `velocity` of faces at liquid that are open; others become unknown.
  void (*apply_pressure)(Grid grid, std::size_t begin, std::size_t end);
  /// `moving` becomes `velocity`, and of unknown faces the mean of the known ones beside them;
  /// where `bring_free` says so and they are open those farther off get `free`.
  void (*extend)(Grid grid, std::size_t begin, std::size_t end, int axis, bool bring_free);
  /// `moving` becomes `velocity` without the slope of `displacement` [m/s for each cell] at liquid.
  void (*move)(Grid grid, std::size_t begin, std::size_t end, const R* displacement, R speed);
  /// Adds those of the rows to `sums`, once velocities are extended; `gained`: from gravity [m/s].
  void (*energies)(Grid grid, std::size_t begin, std::size_t end, const Vec3<R>& gained, EnergySums& sums);
};

/// A level of the multigrid (PressureLevel), as loops over its rows see it.
template <class R>
struct LevelRows {
  const CellRows::Row* rows;
  const R *diagonal, *inverse, *low[3];
  R *x, *b;
};

/// Loops over the rows [begin, end) of a level, which is passed by value: what they write could
/// else be a part of it. Those that return a sum make it in one order.
template <class R>
struct MultigridKernels {
  using Level = LevelRows<R>;
  /// Half a sweep of Gauss and Seidel from x = 0, of the cells of one color; the others become 0.
  void (*first_half_sweep)(Level level, std::size_t begin, std::size_t end, int color);
  void (*half_sweep)(Level level, std::size_t begin, std::size_t end, int color);
  /// The same; returns x . b.
  double (*last_half_sweep)(Level level, std::size_t begin, std::size_t end, int color);
  /// to = b - A x
  void (*residual)(Level level, std::size_t begin, std::size_t end, R* to);
  /// b -= A x of another x; returns b . b.
  double (*take_off)(Level level, std::size_t begin, std::size_t end, const R* x);
  /// y = A x; returns x . y.
  double (*product)(Level level, std::size_t begin, std::size_t end, const R* x, R* y);
  /// direction = x + beta direction, of the level's x.
  void (*turn)(Level level, std::size_t begin, std::size_t end, R beta, R* direction);
  /// x += alpha direction and b -= alpha product; returns b . b.
  double (*advance)(Level level, std::size_t begin, std::size_t end, R alpha, const R* direction, const R* product,
                    R* x);
  /// The right side of a coarser level: of each row's aggregates the sum of the fine residuals `r`.
  /// `children`: the fine rows that a row is made of, by (i * 2 + j) * 2 + half along z.
  void (*gather)(Level coarse, std::size_t begin, std::size_t end, const std::array<std::uint32_t, 8>* children,
                 const R* r);
  /// The matrix of a coarser level: of aggregates the sums of the fine coefficients, times `scale`.
  void (*coarsen)(Level fine, Level coarse, const MatrixRows<R>& to, std::size_t begin, std::size_t end,
                  const std::array<std::uint32_t, 8>* children, R scale);
  /// to = 1 / diagonal, 0 where that is 0.
  void (*invert)(Level level, std::size_t begin, std::size_t end, R* to);
  /// x += that of the aggregates. `parents`: of each row the place of its first cell's.
  void (*spread)(Level fine, std::size_t begin, std::size_t end, const std::uint32_t* parents, const R* coarse);
};

/// The loops that one instruction set has.
template <class R>
struct ProjectionKernels {
  std::string_view isa;
  void (*take)(const BlockTaking<R>& block, BlockMove& found);
  void (*give)(const BlockGiving<R>& block);
  const MultigridKernels<R>& multigrid;
  const RowKernels<R>& rows;
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
