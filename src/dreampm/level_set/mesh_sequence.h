// A mesh that deforms: one file per frame, of constant topology.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dreampm/geometry/changing_region.h"
#include "dreampm/geometry/mesh.h"

namespace dreampm {

/// Vertices move in straight lines from file to file, `fps` [1/s] of them a second from time 0 on;
/// after the last they stand. Between files that lie further apart than a voxel there are as many
/// level sets as keep each within a voxel of the next; distances are interpolated between two.
class MeshSequence final : public ChangingRegion {
 public:
  /// Coordinates times `scale` are meters. `voxel`, `reach` [m] as in mesh_region. Throws
  /// InputError, naming the file, if one cannot be read or has other triangles than the first.
  MeshSequence(std::span<const std::string> files, double fps, double scale, double voxel, double reach);
  ~MeshSequence() override;

  std::shared_ptr<const Region> at(double time) const override;
  Vec3d velocity(const Vec3d& p, double time) const override;
  double fastest(double from, double to) const override;
  double farthest(double from, double to) const override;
  /// Returns its surface at a time, vertices counted from `origin` [m].
  TriMesh mesh(double time, const Vec3d& origin) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm
