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
  write_vdb(path, *r.field);

  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open();
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  ASSERT_TRUE(grid);
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

TEST(Vdb, AFolderThatIsNotThereIsAnError) {
  SparseField field;
  field.voxel = 0.01f;
  EXPECT_THROW(write_vdb("/nowhere/at/all/field.vdb", field), Error);
}

}  // namespace
}  // namespace dreampm
