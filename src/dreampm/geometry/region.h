// A closed part of space that can be asked for its distance, bounds and volume.
#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/math/mat3.h"
#include "dreampm/math/vec.h"
#include "dreampm/shape.h"

namespace dreampm {

/// Points [m], by axis.
struct PointColumns {
  std::array<const double*, 3> at;
  std::size_t count;
};

/// Immutable and safe to ask from many threads.
class Region {
 public:
  virtual ~Region() = default;
  /// Signed distance [m], negative inside. Exact for convex primitives; a bound of the right sign
  /// for CSG; for a mesh exact within its narrow band and clamped to the band's width beyond.
  virtual double distance(const Vec3d& p) const = 0;
  /// Computes the distances at many points, to the same bits.
  virtual void distances(const PointColumns& points, double* to) const;
  /// Outward unit normal (gradient of distance); by central differences unless overridden.
  virtual Vec3d normal(const Vec3d& p) const;
  /// A box that holds the region [m]; infinite for a plane.
  virtual Box3d bounds() const = 0;
};

/// Turns mesh shapes into regions; given by level_set/level_set.h, so that the analytic shapes need
/// no OpenVDB. `reach` [m]: as far as distances are wanted, where that is more than the maker
/// gives.
using MeshRegions = std::function<std::shared_ptr<const Region>(const MeshShape&, double voxel, double reach)>;

/// The turn by `degrees` about an axis, which need not have unit length.
Mat3d rotation_about(const Vec3d& axis, double degrees);

/// Builds the region of a shape. `voxel` [m] is the resolution for meshes. Throws InputError for a
/// PointsShape, for a mesh when `meshes` is empty, and for a container that is none. `reach` [m]:
/// as far as the distances of meshes are wanted.
std::shared_ptr<const Region> make_region(const Shape& shape, double voxel, const MeshRegions& meshes,
                                          double reach = 0);

/// Turned about `own` and moved with it to the center of `shape`, as make_region places forms about
/// the middles of their bounds. The hollow of a container goes with it.
std::shared_ptr<const Region> placed(std::shared_ptr<const Region> form, const Shape& shape, const Vec3d& own);

/// Voxels that faces of the parts of a shape may be apart and still count as one.
inline constexpr double flush = 1e-3;

/// The regions of the parts combined; of a difference the first without the others. At least one.
/// Where a face of one part lies within `same` [m] on a face of another, and nothing of the result
/// is left between them, no surface stays: a hollow that ends flush with its block is open there,
/// and parts of a union that touch are one.
std::shared_ptr<const Region> combined(BooleanShape::Op op, std::vector<std::shared_ptr<const Region>> parts,
                                       double same);

/// The volume [m^3] by counting on a grid of `voxel` with smoothed cell fractions (error
/// O(voxel^2)).
double region_volume(const Region& region, double voxel);

}  // namespace dreampm
