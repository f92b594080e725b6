#include "dreampm/state/world.h"

#include <gtest/gtest.h>

namespace dreampm::world_test {
namespace {

TEST(World, ALayerOnAWallLiesInOneLayerOfBlocks) {
  World<float> w;
  w.dx = 0.25;
  w.origin = {-1, 2, 3};
  w.periodic = {false, false, true};
  w.set_domain({15, 16, 12});
  EXPECT_EQ(w.high - w.low, (Vec3i{15, 16, 12}));
  EXPECT_EQ(w.low.z % block_width, 0) << "a periodic axis begins a block of the grid";
  // Stencils begin at the next node from half a cell on.
  for (const double cells : {0.001, 0.4, 0.6, 2.0, 3.0, 3.49}) {
    const auto home = w.locate(w.origin + Vec3d{cells, cells, 6} * w.dx);
    EXPECT_EQ(home.block.x, 0) << cells;
    EXPECT_EQ(home.block.y, 0) << cells;
  }
  EXPECT_EQ(w.locate(w.origin + Vec3d{3.51, 3.51, 6} * w.dx).block.y, 1);
}

}  // namespace
}  // namespace dreampm::world_test
