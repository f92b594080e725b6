#include "dreampm/surface/bodies.h"

#include <gtest/gtest.h>

namespace dreampm::surface {
namespace {

/// Three balls of a radius of 2.5 voxels, a leaf apart.
SparseField three_balls() {
  SparseField field;
  field.voxel = 1;
  const Vec3f centers[] = {{4, 4, 4}, {12, 4, 4}, {4, 4, 12}};
  for (int z = 0; z < 3; ++z)
    for (int x = 0; x < 3; ++x) field.leaves.push_back({x, 0, z});
  for (const Vec3i& leaf : field.leaves)
    for (int i = 0; i < SparseField::kPoints; ++i) {
      const Vec3f at(leaf * 8 + Vec3i{i % 8, i / 8 % 8, i / 64});
      float most = 0;
      for (const Vec3f& c : centers) most = std::max(most, 1 - length(at - c) / 5);
      field.values.push_back(most);
    }
  return field;
}

TEST(Bodies, AreTheSameBy32AndBy64Bits) {
  SparseField field = three_balls();
  const Walls walls{{{-1, -1, -1}, {25, 9, 25}}, {}};
  const QuadMesh mesh = contour(field, {walls});
  const std::vector<Vec3f> points{{4, 4, 4}, {12, 4, 4}, {4, 4, 12}, {4, 5, 12}, {20, 4, 20}};
  const Bodies narrow = find_bodies(field, mesh, points), wide = find_bodies(field, mesh, points, 0);
  EXPECT_EQ(narrow.count, 3u);
  EXPECT_EQ(wide.count, narrow.count);
  EXPECT_EQ(wide.of_vertex, narrow.of_vertex);
  EXPECT_EQ(wide.of_particle, narrow.of_particle);
  EXPECT_EQ(wide.particles, narrow.particles);
  EXPECT_EQ(narrow.of_particle[2], narrow.of_particle[3]);
  EXPECT_EQ(narrow.of_particle[4], Bodies::kNone);
}

}  // namespace
}  // namespace dreampm::surface
