#include "dreampm/surface/vdb.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <filesystem>

#include "clouds.h"
#include "dreampm/base/error.h"
#include "dreampm/surface/surface.h"

namespace dreampm {
namespace {

TEST(Vdb, TheFileHoldsTheFieldAroundTheMesh) {
  constexpr float kH = 0.01f;
  const Vec3f c{0.2f, 0.2f, 0.2f};
  const auto points = test::lattice(kH, c * 2.0f, [&](const Vec3f& p) { return length(p - c) < 0.15f; });
  const SurfaceResult r = reconstruct({.positions = points, .spacing = kH}, {.smooth = 0, .keep_field = true});
  ASSERT_TRUE(r.field);
  ASSERT_FALSE(r.field->inside.empty());
  const auto path = std::filesystem::path(testing::TempDir()) / "dreampm_field.vdb";
  write_fog_vdb(path, *r.field);

  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(grid->metaValue<float>("iso"), 0.5f);
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sample(*grid);
  const auto value = [&](const Vec3f& p) { return sample.wsSample(openvdb::Vec3d(p.x, p.y, p.z)); };
  EXPECT_NEAR(value(c), 1, 0.1f);
  EXPECT_EQ(value({0, 0, 0}), 0);
  double mean = 0;
  for (const Vec3f& v : r.mesh.vertices) mean += static_cast<double>(value(v));
  EXPECT_NEAR(mean / static_cast<double>(r.mesh.vertices.size()), 0.5, 0.06);
  file.close();
  std::filesystem::remove(path);
}

TEST(Vdb, TheLevelSetHoldsDistancesFromTheMesh) {
  constexpr float kH = 0.01f;
  const Vec3f c{0.2f, 0.2f, 0.2f};
  const auto points = test::lattice(kH, c * 2.0f, [&](const Vec3f& p) { return length(p - c) < 0.15f; });
  const TriMesh mesh = reconstruct({.positions = points, .spacing = kH}).mesh;
  const auto path = std::filesystem::path(testing::TempDir()) / "dreampm_distances.vdb";
  const Vec3d shift{1e5, 0, -2};
  write_level_set_vdb(path, mesh, 0.5f * kH, shift);

  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("surface"));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_NEAR(grid->voxelSize().x(), 0.005, 1e-9);
  EXPECT_NEAR(grid->background(), 0.015, 1e-6) << "a band of three voxels";
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sample(*grid);
  const auto value = [&](const Vec3f& p) {
    return sample.wsSample(openvdb::Vec3d(p.x, p.y, p.z) + openvdb::Vec3d(shift.x, shift.y, shift.z));
  };
  EXPECT_NEAR(value(c), -0.015, 1e-6);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 97) {
    EXPECT_NEAR(value(mesh.vertices[v]), 0, 0.001f);
    EXPECT_NEAR(value(mesh.vertices[v] + mesh.normals[v] * kH), 0.01, 0.001);
    EXPECT_NEAR(value(mesh.vertices[v] - mesh.normals[v] * kH), -0.01, 0.001);
  }
  file.close();
  std::filesystem::remove(path);
}

TEST(Vdb, AFolderThatIsNotThereIsAnError) {
  SparseField field;
  field.voxel = 0.01f;
  EXPECT_THROW(write_fog_vdb("/nowhere/at/all/field.vdb", field), Error);
  EXPECT_THROW(write_level_set_vdb("/nowhere/at/all/field.vdb", {}, 0.01f), Error);
}

}  // namespace
}  // namespace dreampm
