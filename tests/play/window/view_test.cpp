// Which look is drawn, and what pictures keep.
#include "dreampm/play/window/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "dreampm/gl/headless.h"
#include "play/small_scene.h"

namespace dreampm::play::view_test {
namespace {
using namespace test;

/// That many seconds on a machine where each rung takes so long; how often the rung changed.
int changes(LookLadder& ladder, const std::array<double, 3>& ms, double seconds, double load = 1) {
  int count = 0;
  for (double at = 0; at < seconds;) {
    const int before = ladder.rung();
    const double own = ms[static_cast<std::size_t>(before)], shown = std::max(1e-3 * own, 1.0 / 60);
    ladder.took(own, load, shown);
    at += shown;
    count += ladder.rung() != before;
  }
  return count;
}

TEST(LookLadder, GoesDownToWhatIsInTimeAndStaysThere) {
  LookLadder ladder;
  EXPECT_EQ(changes(ladder, {75, 15, 5}, 4), 1);
  EXPECT_EQ(ladder.rung(), 1);
  // It looks again at times, and ever more seldom.
  const int often = changes(ladder, {75, 15, 5}, 60), seldom = changes(ladder, {75, 15, 5}, 60);
  EXPECT_LE(often, 8);
  EXPECT_LE(seldom, 2);
  EXPECT_EQ(ladder.rung(), 1);
}

TEST(LookLadder, SecondsAndNotPicturesTakeItDown) {
  // Of 450 ms each there are four in that time.
  LookLadder ladder;
  EXPECT_EQ(changes(ladder, {450, 30, 20}, 2.6), 1);
  LookLadder quick;
  EXPECT_EQ(changes(quick, {75, 30, 20}, 1.2), 0) << "a moment is none";
}

TEST(LookLadder, OneBusyMomentDoesNotDecideForGood) {
  LookLadder ladder;
  changes(ladder, {139, 80, 70}, 5);
  ASSERT_GT(ladder.rung(), 0) << "the machine is busy";
  // It is quiet: water and spheres take what is in time, and points alone more than 20 ms.
  changes(ladder, {55, 37, 33}, 15);
  EXPECT_EQ(ladder.rung(), 0);
  EXPECT_EQ(changes(ladder, {55, 37, 33}, 60), 0);
}

TEST(LookLadder, ARungDownThatGainsNothingIsTakenBack) {
  LookLadder ladder;
  changes(ladder, {140, 80, 78}, 10);
  EXPECT_EQ(ladder.rung(), 1) << "points are no quicker than spheres";
  LookLadder other;
  changes(other, {90, 85, 82}, 10);
  EXPECT_EQ(other.rung(), 0) << "nor is anything than water";
  LookLadder last;
  changes(last, {90, 85, 30}, 10);
  EXPECT_EQ(last.rung(), 2) << "but points are";
}

TEST(LookLadder, GoesUpWhereThereIsLessToDraw) {
  LookLadder ladder;
  changes(ladder, {140, 15, 5}, 4, 2);
  ASSERT_EQ(ladder.rung(), 1);
  EXPECT_EQ(changes(ladder, {52, 7, 3}, 4, 0.75), 1);
  EXPECT_EQ(ladder.rung(), 0);
}

TEST(LookLadder, TheQuickestIsTheLast) {
  LookLadder ladder;
  EXPECT_EQ(changes(ladder, {500, 300, 200}, 20), 2);
  EXPECT_EQ(ladder.rung(), 2);
}

TEST(View, AutomaticBeginsWithMatter) {
  const gl::HeadlessContext context;
  const gl::Framebuffer framebuffer(32, 32);
  View view;
  Playground playground(small_scene(), quiet_options());
  for (const auto& [look, name] : {std::pair{0.0, "matter"}, {1.0, "points"}, {0.0, "matter"}}) {
    Frame frame = *playground.frame();
    frame.settings.look = look;
    view.draw(frame, camera_of(frame), std::nullopt, framebuffer);
    EXPECT_EQ(view.look(), name);
  }
}

TEST(View, AMeshLivesUntilAnotherIsDrawnInItsPlace) {
  // Else a new one may lie where it lay, and pass for it.
  const gl::HeadlessContext context;
  const gl::Framebuffer framebuffer(32, 32);
  View view;
  Playground playground(small_scene(), quiet_options());
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
}  // namespace dreampm::play::view_test
