// Volumes, read back by OpenVDB.
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include "clips.h"

namespace dreampm::test {
namespace {

using Volumes = InOwnFolder;

template <class Grid>
typename Grid::ValueType at(const openvdb::GridBase::Ptr& grid, const Vec3d& p) {
  const openvdb::tools::GridSampler<Grid, openvdb::tools::BoxSampler> sample(*openvdb::gridPtrCast<Grid>(grid));
  return sample.wsSample(openvdb::Vec3d(p.x, p.y, p.z));
}

TEST_F(Volumes, HoldALevelSetAndVelocities) {
  const Axes axes{Up::z, 100};
  const Vec3d shift{1e6, 0, 0};
  ClipInfo clip = clip_of_two(axes);
  clip.shift = shift;
  writer_of("vdb", clip, folder)->add(frame_of_two(2, axes));

  openvdb::io::File file((folder / "small_000002.vdb").string());
  file.open();
  EXPECT_EQ(file.getMetadata()->metaValue<double>("time"), 0.04);
  EXPECT_EQ(file.getMetadata()->metaValue<double>("fps"), 25);
  const auto surface = file.readGrid("surface"), velocity = file.readGrid("velocity");
  EXPECT_EQ(surface->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_DOUBLE_EQ(surface->voxelSize().x(), 5);
  // The oblique face x + y + z = 1 m, and 5 cm before and behind it along its normal.
  const Vec3d on{1.0 / 3, 1.0 / 3, 1.0 / 3}, normal{0.0288675, 0.0288675, 0.0288675};
  const auto distance = [&](const Vec3d& p) { return at<openvdb::FloatGrid>(surface, axes.placed(p) + shift); };
  EXPECT_NEAR(distance(on), 0, 0.2f);
  EXPECT_NEAR(distance(on + normal), 5, 0.2f);
  EXPECT_NEAR(distance(on - normal), -5, 0.2f);
  const auto v = at<openvdb::Vec3SGrid>(velocity, axes.placed(Vec3d{0.25, 0.25, 0.25}) + shift);
  EXPECT_NEAR(v.x(), 0, 1e-3f);
  EXPECT_NEAR(v.y(), 0, 1e-3f);
  EXPECT_NEAR(v.z(), -200, 1e-2f) << "down along z, in centimeters a second";
  file.close();
}

}  // namespace
}  // namespace dreampm::test
