// Which look is drawn, and what pictures keep.
#include "dreampm/play/view.h"

#include <gtest/gtest.h>

#include "dreampm/gl/headless.h"
#include "small_stage.h"

namespace dreampm::play {
namespace {
using namespace test;

/// Pictures on a machine where each rung takes so long; how often the rung changed.
int changes(LookLadder& ladder, const std::array<double, 3>& ms, int pictures, double load = 1) {
  int count = 0;
  for (int n = 0; n < pictures; ++n) {
    const int before = ladder.rung();
    ladder.took(ms[static_cast<std::size_t>(before)], load);
    count += ladder.rung() != before;
  }
  return count;
}

TEST(LookLadder, GoesDownToWhatIsInTimeAndStaysThere) {
  LookLadder ladder;
  EXPECT_EQ(changes(ladder, {75, 15, 5}, 250), 1);
  EXPECT_EQ(ladder.rung(), 1);
  // It looks again at times, and ever more seldom.
  const int often = changes(ladder, {75, 15, 5}, 3000), seldom = changes(ladder, {75, 15, 5}, 3000);
  EXPECT_LE(often, 8);
  EXPECT_LE(seldom, 2);
  EXPECT_EQ(ladder.rung(), 1);
}

TEST(LookLadder, GoesUpAtOnceWhereThereIsLessToDraw) {
  LookLadder ladder;
  changes(ladder, {140, 15, 5}, 100, 2);
  ASSERT_EQ(ladder.rung(), 1);
  EXPECT_EQ(changes(ladder, {55, 7, 3}, 100, 0.75), 1);
  EXPECT_EQ(ladder.rung(), 0);
}

TEST(LookLadder, TheQuickestIsTheLast) {
  LookLadder ladder;
  EXPECT_EQ(changes(ladder, {500, 400, 300}, 1000), 2);
  EXPECT_EQ(ladder.rung(), 2);
}

TEST(View, AMeshLivesUntilAnotherIsDrawnInItsPlace) {
  // Else a new one may lie where it lay, and pass for it.
  const gl::HeadlessContext context;
  const gl::Framebuffer framebuffer(32, 32);
  View view;
  Playground playground(small_stage(), quiet_options());
  Frame frame = *playground.frame();
  const auto shown = [&] {
    TriMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    frame.bodies = {{}};
    frame.bodies[0].mesh = std::make_shared<const TriMesh>(mesh);
    view.draw(frame, camera_of(frame), std::nullopt, framebuffer);
    return std::weak_ptr<const TriMesh>(std::exchange(frame.bodies, {})[0].mesh);
  };
  const auto first = shown();
  EXPECT_FALSE(first.expired());
  view.draw(frame, camera_of(frame), std::nullopt, framebuffer);
  EXPECT_FALSE(first.expired()) << "while nothing is in its place";
  const auto second = shown();
  EXPECT_TRUE(first.expired());
  EXPECT_FALSE(second.expired());
}

}  // namespace
}  // namespace dreampm::play
