// Meshes as regions: signed distance on a grid, right for meshes with holes, overlaps and loose
// pieces.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/geometry/model.h"
#include "dreampm/geometry/region.h"

namespace dreampm {

/// A mesh has no inside, or none that is as thick as a voxel.
class EnclosesNothing : public InputError {
 public:
  using InputError::InputError;
};

/// The inside of `mesh` (m), sampled at `voxel` [m]. The distance comes from OpenVDB, its sign from
/// the generalized winding number (winding_number.h), so holes are closed by the smoothest cap
/// instead of leaking. Distances are those to the mesh within about a voxel, and clamped to +-3
/// voxels, or to `reach` [m] where that is more; details thinner than about a voxel are lost.
/// bounds() are those of the mesh; normal() is the gradient. `name` is for messages. Throws
/// EnclosesNothing, and InputError for a mesh that would need more than 2^31 voxels.
std::shared_ptr<const Region> mesh_region(const TriMesh& mesh, double voxel, const std::string& name);

/// Volume [m^3] inside the level set of a region made by mesh_region; InputError for any other
/// region.
double level_set_volume(const Region& region);

/// The same of a mesh in double, of which `factor` times the coordinates are taken.
std::shared_ptr<const Region> mesh_region(const Model& model, double factor, double voxel, const std::string& name,
                                          double reach = 0);

/// The thickness [m] of a wall of the mesh's volume and area; 0 without an area.
double thickness_of(const Model& model);
/// The voxel [m] for a mesh that is a wall of that thickness [m], where others are sampled at
/// `voxel`: half of the thickness, but a quarter of `voxel` at least.
double voxel_of_wall(double thickness, double voxel);

/// The properties of a mesh before any distance is known, sized as its shape asks.
struct MeshLook {
  Box3d bounds;                  ///< m
  std::optional<double> volume;  ///< m^3, of a mesh that is closed and one part; others may enclose a place twice
  /// m, of a wall of its volume and area: twice the one by the other; a third of the side of a
  /// cube. Absent where it encloses nothing.
  std::optional<double> thickness;
  double area = 0;  ///< m^2, of all faces
  std::size_t triangles = 0;
};

/// Reads each file or asset once, and gives what scenes want of it.
class Meshes {
 public:
  /// The destination of warnings about a file (its model's, faces that look inward, wide holes):
  /// the log when it is read, or warnings().
  enum class Say { log, keep };
  explicit Meshes(Say say);
  std::vector<std::string> warnings() const;
  /// Returns regions for make_region: sizes the mesh (`longest` or `scale`, about the file's
  /// origin), and makes its region. Equal requests share one region while it lives. `reach` as in
  /// mesh_region.
  MeshRegions regions(double reach = 0) const;
  /// Regions whose voxels are down to a quarter of those asked for where the mesh is a thin wall,
  /// so that two take up its thickness: a wall of one may fall between the places that are sampled.
  /// Distances reach as far as those of regions().
  MeshRegions fine_regions() const;
  /// The shells of that thickness [m] about meshes (shell.h). Of these it is not said that they are
  /// open.
  MeshRegions shells(double thickness, double reach) const;
  /// Returns regions for make_region where only bounds are asked for: distances are those to the
  /// bounds.
  MeshRegions boxes() const;
  MeshLook look(const MeshShape& shape) const;

 private:
  struct Made;
  std::shared_ptr<Made> made_;
};

/// Meshes(log).regions().
MeshRegions mesh_regions();

}  // namespace dreampm
