// Shells: walls of a given thickness about a surface, for colliders whose mesh is a sheet or an
// open cup.
#pragma once
#include <memory>
#include <string>

#include "dreampm/base/error.h"
#include "dreampm/level_set/level_set.h"

namespace dreampm {

/// A shell would need more than a GiB.
class ShellTooLarge : public InputError {
 public:
  ShellTooLarge(const std::string& what, double enough_voxel) : InputError(what), voxel(enough_voxel) {}
  /// [m] One that would do for a shell at least 3 voxels thick whose distances reach at least 4.5
  /// voxels.
  double voxel;
};

/// All within thickness/2 [m] of the faces of `mesh`, whichever way they look. The distance is
/// sampled at `voxel` [m], at most a third of the thickness, since it has a kink in the middle of
/// the shell; it is clamped at `reach` [m] from the shell. `name` is for messages. Throws
/// ShellTooLarge.
std::shared_ptr<const Region> mesh_shell(const Model& mesh, double factor, double thickness, double voxel, double reach,
                                         const std::string& name);

/// The shell of that thickness about the surface of a shape: of a mesh about its faces, of others
/// about the place where their distance is 0, so that they are hollow. `voxel` and `reach` [m] are
/// for meshes.
std::shared_ptr<const Region> shell_region(const Shape& shape, double thickness, double voxel, double reach,
                                           const Meshes& meshes);

}  // namespace dreampm
