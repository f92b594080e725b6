// Walls of the box that hands drag.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dreampm/model/scene.h"
#include "dreampm/play/tools/cursor.h"
#include "dreampm/play/tools/wall_face.h"
#include "play/small_scene.h"

namespace dreampm::play::walls_test {
namespace {
using namespace test;
using testing::HasSubstr;

/// How far matter reaches along x, and how many particles lie more than a tenth of a cell behind
/// the walls.
struct Spread {
  double max = 0;
  int outside = 0;
};
Spread spread(const Frame& frame) {
  Spread s;
  const double slack = 0.1 * 2 * frame.spacing;
  for (const MatterFrame& m : frame.matter)
    for (const Vec3f& x : m.position) {
      const Vec3d at = static_cast<Vec3d>(x);
      s.max = std::max(s.max, at.x);
      for (int a = 0; a < 3; ++a) s.outside += at[a] < frame.room.min[a] - slack || at[a] > frame.room.max[a] + slack;
    }
  return s;
}

TEST(Walls, ADraggedWallPushesMatterAndLosesNone) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 12"});
  const std::size_t before = p.simulation().particle_count();
  const double mass = p.simulation().totals().mass;
  EXPECT_TRUE(p.frame()->bodies.empty());
  play(p, {"wall x_max 0.2"});
  double last = 0.4;
  for (int n = 0; n < 50; ++n) {
    play(p, {"frames 1"});
    const std::shared_ptr<const Frame> frame = p.frame();
    EXPECT_EQ(spread(*frame).outside, 0) << n;
    EXPECT_LE(frame->room.max.x, last + 1e-9);
    EXPECT_GE(frame->room.max.x, last - 0.4 / 60 * 1.2) << "its speed has an end";
    last = frame->room.max.x;
  }
  EXPECT_NEAR(last, 0.2, 0.002);
  EXPECT_EQ(p.simulation().particle_count(), before);
  EXPECT_NEAR(p.simulation().totals().mass, mass, 1e-9 * mass);
  ASSERT_EQ(p.frame()->bodies.size(), 1u) << "it is drawn";
  play(p, {"wall off", "frames 60"});
  EXPECT_EQ(p.frame()->room.max.x, 0.4);
  EXPECT_TRUE(p.frame()->bodies.empty()) << "back at its place it is the wall of the box again";
  EXPECT_EQ(p.simulation().scene().model().colliders.size(), 0u);
  EXPECT_GT(spread(*p.frame()).max, 0.3);
}

// Water that fills its room gives no more way, and a block of stone before the other wall neither:
// the wall stands still there.
TEST(Walls, StopWhereMatterDoesNotGiveWay) {
  for (const char* kind : {"0", "7"}) {
    Playground p(small_scene(), quiet_options());
    play(p, {"erase 0.2 0.2 0.12 0.5", std::string("set matter ") + kind, "drop box 0.2 0.13 0.12 0.22", "frames 5",
             "wall x_max 0.08"});
    const std::size_t before = p.simulation().particle_count();
    for (int n = 0; n < 75; ++n) {
      play(p, {"frames 1"});
      ASSERT_EQ(spread(*p.frame()).outside, 0) << kind << " " << n;
    }
    const double room = p.frame()->room.size().x, least = kind[0] == '0' ? std::pow(0.22, 3) / (0.4 * 0.24) : 0.22;
    EXPECT_GT(room, 0.9 * least) << kind;
    EXPECT_LT(room, 1.25 * least) << kind;
    EXPECT_EQ(p.simulation().particle_count(), before);
    EXPECT_EQ(p.frame()->message, "") << kind;
    const Totals all = p.simulation().totals();
    EXPECT_LT(length(all.momentum), 0.1 * all.mass) << kind << ": it comes to rest";
  }
}

TEST(Walls, PushABodyOnAndStopWhereItIsHeld) {
  const PlayScene box{
      "box", parse_scene("dreampm: 1\nname: box\nspace: {min: [0, 0, 0], max: [0.24, 0.32, 0.24], spacing: 0.02}\n"
                         "time: {fps: 60}\nmaterials:\n  jelly: {type: elastic, preset: jelly}\nbodies:\n  crumb: "
                         "{material: jelly, shape: {box: {min: [0, 0, 0], max: [0.02, 0.02, 0.02]}}}\n",
                         "box.yaml")};
  Playground p(box, quiet_options());
  play(p, {"drop crate 0.12 0.06 0.14 0.1", "frames 2", "wall x_max 0.06", "frames 54"});
  const double plane = p.frame()->room.max.x, middle = p.simulation().collider("crate-1").twist.center.x;
  EXPECT_LT(middle, 0.075) << "it was pushed on";
  EXPECT_GT(middle, 0.045);
  EXPECT_GT(plane, 0.09) << "and is not run over";
  EXPECT_LT(plane, 0.14);
}

TEST(Walls, RepeatThemselvesAndAreUndone) {
  const std::vector<std::string> lines{"frames 3", "wall x_max 0.25", "frames 6", "wall z_min 0.06", "frames 8"};
  std::uint64_t one = 0;
  for (const int threads : {1, 2}) {
    Playground p(small_scene(), quiet_options(threads));
    play(p, lines);
    if (threads == 1) one = p.hash();
    EXPECT_EQ(p.hash(), one);
    if (threads == 1) continue;
    play(p, {"undo"});
    EXPECT_LT(p.frame()->room.max.x, 0.4);
    EXPECT_EQ(p.frame()->room.min.z, 0);
    const double stands = p.frame()->room.max.x;
    play(p, {"frames 4"});
    EXPECT_EQ(p.frame()->room.max.x, stands) << "a hand of the past lets go";
    play(p, {"undo", "frames 2"});
    EXPECT_EQ(p.frame()->room.max.x, 0.4);
    play(p, {"restart", "frames 2"});
    EXPECT_TRUE(p.frame()->bodies.empty());
  }
}

TEST(Walls, ASavedSceneHasThemWhereTheyStand) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "play-walls";
  std::filesystem::remove_all(folder);
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 3", "wall x_max 0.34", "frames 20", "save " + (folder / "tank.yaml").string()});
  const double stands = p.frame()->room.max.x;
  Playground again(load_play_scene((folder / "tank.yaml").string()), quiet_options());
  EXPECT_NEAR(again.frame()->room.max.x, stands, 1e-12);
  play(again, {"frames 12"});
  EXPECT_GT(spread(*again.frame()).max, 0.3);
  EXPECT_LT(spread(*again.frame()).max, stands + 0.002) << "a block fills what it left";
  // And from there on again.
  play(again, {"wall x_max 0.38", "frames 2", "save " + (folder / "again.yaml").string()});
  const Scene twice = load_scene(folder / "again.yaml");
  ASSERT_EQ(twice.model().colliders.size(), 1u);
  EXPECT_EQ(twice.model().colliders[0].name, "wall-x_max");
}

// A wall that stands where it was dragged to, and one that is pressed on.
TEST(Walls, ASavedSceneGoesOnToTheBit) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "play-walls-bits";
  std::filesystem::remove_all(folder);
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 3", "wall x_max 0.34", "wall z_min 0.03", "frames 40", "save " + (folder / "tank.yaml").string()});
  Simulation after(load_scene(folder / "tank.yaml"), quiet_options().simulation);
  EXPECT_EQ(after.hash(), p.hash());
  play(p, {"steps 60"});
  after.advance_steps(60);
  EXPECT_EQ(after.hash(), p.hash());
  EXPECT_EQ(after.totals().kinetic, p.simulation().totals().kinetic);
}

TEST(Walls, SayWhatIsWrong) {
  Playground p(small_scene(), quiet_options());
  EXPECT_THAT(refusal(p, "wall left 0.2"), HasSubstr("x_min, x_max"));
  EXPECT_THAT(refusal(p, "wall x_max 0.01"), HasSubstr("must be between 0.08 and 0.4"));
  EXPECT_THAT(refusal(p, "wall x_max 0.5"), HasSubstr("must be between"));
  EXPECT_FALSE(p.frame()->can_undo);
}

TEST(Walls, ARayMeetsTheOneBehindOrBeforeTheFloor) {
  const Box3d room{{0, 0, 0}, {1, 1, 1}};
  const auto face = [&](const Vec3f& from, const Vec3f& to) {
    return pick_wall(room, {from, (to - from) * (1 / std::sqrt(dot(to - from, to - from)))});
  };
  const auto level = face({0.5f, 0.5f, 3}, {0.5f, 0.5f, 0});
  ASSERT_TRUE(level);
  EXPECT_EQ(level->side, Side::z_min);
  EXPECT_NEAR(level->at.z, 0, 1e-6);
  EXPECT_EQ(face({0.5f, 1.5f, 3}, {0.5f, 0, 0.8f})->side, Side::z_max) << "through it the floor is seen";
  EXPECT_EQ(face({0.5f, 3, 0.6f}, {0.5f, 0, 0.5f})->side, Side::y_max);
  EXPECT_EQ(face({3, 0.5f, 0.5f}, {0, 0.4f, 0.5f})->side, Side::x_min);
  EXPECT_EQ(face({0.5f, 0.5f, 3}, {0.5f, 4, 0}), std::nullopt);
  // A ray that passes the line of the drag on its way.
  const auto to = drawn_to(Side::x_max, {1, 0.5, 0.5}, {{0.7f, 0.5f, 3}, {0, 0, -1}});
  ASSERT_TRUE(to);
  EXPECT_NEAR(*to, 0.7, 1e-6);
  EXPECT_EQ(drawn_to(Side::x_max, {1, 0.5, 0.5}, {{3, 0.5f, 0.5f}, {-1, 0, 0}}), std::nullopt);
}

// The hand is as strong as it is: what presses on a wall slows it.
TEST(Walls, TicksThatAreCutShortReplayToTheSameBits) {
  Playground live(small_scene(), quiet_options()), again(small_scene(), quiet_options());
  int calls = 0;
  for (Playground* p : {&live, &again}) play(*p, {"set gravity.y -10"});
  live.act(Action::parse("wall x_max 0.13")), again.act(Action::parse("wall x_max 0.13"));
  for (int n = 0; n < 120; ++n) {
    // A tick that is short of time does its steps in several calls.
    const int steps = live.tick({std::nullopt, 4e-3});
    again.tick({steps, {}});
    calls += steps;
    ASSERT_EQ(live.hash(), again.hash()) << n;
  }
  EXPECT_GT(calls, 120);
  EXPECT_LT(live.frame()->room.max.x, 0.32) << "it presses on the cube";
}

}  // namespace
}  // namespace dreampm::play::walls_test
