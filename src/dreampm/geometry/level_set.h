// Meshes as regions: signed distance on a grid, right for meshes with holes, overlaps and loose pieces.
#pragma once
#include <memory>

#include "dreampm/geometry/mesh.h"
#include "dreampm/geometry/region.h"

namespace dreampm {

/// The inside of `mesh` (m), sampled at `voxel` [m]. The distance comes from OpenVDB, its sign from the generalized
/// winding number (winding_number.h), so holes are closed by the smoothest cap instead of leaking. Distances are
/// those to the mesh within about a voxel, and clamped to +-3 voxels; details thinner than about a voxel are lost.
/// bounds() are those of the mesh; normal() is the gradient. `name` is for messages. Throws InputError for a mesh that
/// encloses nothing at this voxel, and for one that would need more than 2^31 voxels.
std::shared_ptr<const Region> mesh_region(const TriMesh& mesh, double voxel, const std::string& name);

/// Volume [m^3] inside the level set of a region made by mesh_region; InputError for any other region.
double level_set_volume(const Region& region);

/// The factory for make_region: reads the file or asset, scales it (`longest` or `scale`, about the file's origin), and
/// makes its region. Equal requests share one region while it lives.
MeshRegions mesh_regions();

}  // namespace dreampm
