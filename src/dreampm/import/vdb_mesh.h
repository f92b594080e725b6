// A mesh as OpenVDB's tools take it. For files that include OpenVDB themselves.
#pragma once
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/import/vdb_grids.h"

namespace dreampm {

inline std::vector<openvdb::Vec3s> vdb_points(const TriMesh& mesh) {
  std::vector<openvdb::Vec3s> points;
  points.reserve(mesh.vertices.size());
  for (const Vec3f& v : mesh.vertices) points.emplace_back(v.x, v.y, v.z);
  return points;
}
inline std::vector<openvdb::Vec3I> vdb_triangles(const TriMesh& mesh) {
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  return triangles;
}

}  // namespace dreampm
