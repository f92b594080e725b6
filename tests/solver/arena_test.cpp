// The nodes of an arena that a particle reaches are worked out twice: by its stencil, and for a
// whole block by the ends of its particles. Both have to agree, or nodes that are given to are
// never added to the grid.
#include "dreampm/backend/cpu/arena.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dreampm/physics/transfer.h"

namespace dreampm::arena_test {
namespace {

TEST(Arena, AParticlesFirstNodeIsThatOfItsStencil) {
  int checked = 0;
  for (float at = -0.5f; at <= 4.5f; at += 0.5f)
    for (const float towards : {-9.0f, 9.0f}) {
      float u = at;
      for (int ulps = 0; ulps < 40; ++ulps, u = std::nextafter(u, towards), ++checked)
        EXPECT_EQ(first_node(u), make_stencil(Vec3<float>{u, 0, 0}).node(0) + 1) << std::hexfloat << u;
    }
  for (float u = -0.95f; u <= 4.95f; u += 1.0f / 512)
    EXPECT_EQ(first_node(u), static_cast<int>(std::floor(u)) + 1) << u;
  EXPECT_EQ(checked, 11 * 2 * 40);
}

TEST(Arena, NoPositionLeadsOutOfIt) {
  for (const float u : {-1e9f, -1.0f, 5.0f, 1e9f}) {
    EXPECT_GE(first_node(u), 0) << u;
    EXPECT_LE(first_node(u) + 2, arena_width - 1) << u;
  }
}

}  // namespace
}  // namespace dreampm::arena_test
