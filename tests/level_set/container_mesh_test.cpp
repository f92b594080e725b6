// Containers whose hollow is a mesh.
#include "dreampm/geometry/container.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dreampm/level_set/level_set.h"

namespace dreampm::container_mesh_test {
namespace {

constexpr double voxel = 0.01;

ContainerShape about_the_knot() {
  Shape knot;
  knot.form = MeshShape{"asset:knot", 0.6, {}};
  knot.rotate_axis = {1, 0, 0}, knot.rotate_angle = 35;
  ContainerShape c;
  c.hollow = {knot};
  c.wall = 0.08;  // more than the three voxels that a mesh's distances reach by themselves
  return c;
}

TEST(MeshContainer, ABlockIsTheTightBoxWithoutTheMesh) {
  const Meshes meshes(Meshes::Say::log);
  const ContainerShape c = about_the_knot();
  const ContainerParts parts = container_parts(c, voxel, meshes.fine_regions(), 0);
  const auto knot = make_region(c.hollow[0], voxel, meshes.regions());
  // Its own bounds are those of a turned box; the knot itself fills less.
  EXPECT_LT(parts.box.size().z, knot->bounds().size().z + 2 * c.wall - 0.02);
  Box3d seen;
  for (double x = -0.5; x < 0.5; x += 0.007)
    for (double y = -0.5; y < 0.5; y += 0.007)
      for (double z = -0.5; z < 0.5; z += 0.007)
        if (knot->distance({x, y, z}) < 0) seen.add({x, y, z});
  const double height = seen.size().y;
  EXPECT_NEAR(parts.box.min.y, seen.min.y - c.wall, 0.007);
  EXPECT_NEAR(parts.box.max.y, seen.max.y - default_cut * height, 0.007);
  EXPECT_NEAR(parts.box.max.z, seen.max.z + c.wall, 0.007);
  EXPECT_NEAR(parts.box.min.x, seen.min.x - c.wall, 0.007);
  const Vec3d size = parts.box.size();
  const double hollow = region_volume(*parts.hollow, voxel);
  EXPECT_NEAR(region_volume(*parts.solid, voxel) / (size.x * size.y * size.z - hollow), 1, 0.005);
}

TEST(MeshContainer, AShellIsAsThickAsItsWall) {
  const Meshes meshes(Meshes::Say::log);
  ContainerShape c = about_the_knot();
  c.form = ContainerShape::Form::shell;
  const ContainerParts parts = container_parts(c, voxel, meshes.fine_regions(), 0);
  const auto knot = make_region(c.hollow[0], voxel, meshes.regions(c.wall + 0.03));
  for (double t = -0.4; t < 0.4; t += 0.0123) {
    const Vec3d p{t, -0.05, 0.3 * t};
    const double d = knot->distance(p);
    if (std::min(std::abs(d), std::abs(d - c.wall)) < 0.2 * voxel) continue;
    EXPECT_EQ(parts.solid->distance(p) < 0, d > 0 && d < c.wall) << t << ": " << d;
  }
}

}  // namespace
}  // namespace dreampm::container_mesh_test
