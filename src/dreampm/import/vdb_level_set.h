// The level set of a mesh as other programs get it. For files that include OpenVDB themselves.
#pragma once
#include <openvdb/tools/MeshToVolume.h>

#include "dreampm/import/vdb_grids.h"
#include "dreampm/import/vdb_mesh.h"

namespace dreampm {

/// Cubes of that edge; the origin lies at `at`.
inline openvdb::math::Transform::Ptr vdb_transform(double voxel, const Vec3d& at) {
  auto t = openvdb::math::Transform::createLinearTransform(voxel);
  t->postTranslate(openvdb::Vec3d(at.x, at.y, at.z));
  return t;
}

/// Distances from a closed mesh within three voxels of it, negative inside. `shift`: where its
/// places count from; the transform has it.
inline openvdb::FloatGrid::Ptr vdb_level_set(const TriMesh& mesh, double voxel, const Vec3d& shift) {
  constexpr float half_width = 3;
  auto grid = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*vdb_transform(voxel, {}), vdb_points(mesh),
                                                                 vdb_triangles(mesh), half_width);
  grid->setTransform(vdb_transform(voxel, shift));
  return grid;
}

}  // namespace dreampm
