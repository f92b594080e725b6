// Rigid bodies that hands drop, hold and take out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dreampm/model/scene.h"
#include "dreampm/play/tools/cursor.h"
#include "play/small_scene.h"

namespace dreampm::play::bodies_test {
namespace {
using namespace test;
using testing::HasSubstr;

/// A small pool: bodies take their time.
PlayScene pool() {
  return {"pool",
          parse_scene("dreampm: 1\nname: pool\nspace: {min: [0, 0, 0], max: [0.32, 0.4, 0.16], spacing: 0.02}\n"
                      "time: {fps: 60}\nmaterials:\n  water: {type: newtonian, preset: water, max_compression: 0.03}\n"
                      "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.32, 0.08, 0.16]}}}\n",
                      "pool.yaml")};
}

Vec3d middle_of(Playground& p, const std::string& name) { return p.simulation().collider(name).twist.center; }

std::size_t bodies(Playground& p) { return p.frame()->bodies.size(); }

TEST(Bodies, WhatIsDroppedFallsIsDrawnAndMayBeTakenBack) {
  Playground p(pool(), quiet_options());
  play(p,
       {"frames 3", "drop crate 0.16 0.3 0.08 0.08", "drop brick 0.25 0.3 0.08 0.08", "drop ball 0.06 0.3 0.08 0.08"});
  const std::shared_ptr<const Frame> first = p.frame();
  ASSERT_EQ(first->bodies.size(), 3u);
  EXPECT_EQ(first->bodies[0].name, "crate-1");
  EXPECT_TRUE(first->bodies[0].rigid);
  const double mass = p.simulation().collider("crate-1").mass;
  EXPECT_NEAR(mass, 400 * 0.08 * 0.08 * 0.08, 0.01 * mass);
  play(p, {"frames 12"});
  const std::shared_ptr<const Frame> later = p.frame();
  for (std::size_t b = 0; b < 3; ++b) {
    const auto middle = [&](const Frame& f) {
      Box3d box;
      for (const Vec3f& v : f.bodies[b].mesh->vertices) box.add(static_cast<Vec3d>(v));
      return f.bodies[b].pose(box.center());
    };
    EXPECT_LT(middle(*later).y, middle(*first).y - 0.05) << later->bodies[b].name;
    EXPECT_EQ(later->bodies[b].mesh, first->bodies[b].mesh) << "made once";
  }
  play(p, {"undo"});
  EXPECT_EQ(bodies(p), 2u);
  play(p, {"redo"});
  EXPECT_EQ(bodies(p), 3u);
  play(p, {"restart", "frames 2"});
  EXPECT_EQ(bodies(p), 0u);
  play(p, {"undo", "frames 2"});
  EXPECT_EQ(bodies(p), 3u);
  // Back before they were there, and forward again.
  play(p, {"seek 0.2"});
  EXPECT_EQ(bodies(p), 0u);
  play(p, {"seek 0", "drop ball 0.16 0.36 0.08 0.06"});
  EXPECT_EQ(bodies(p), 4u);
}

TEST(Bodies, AHandThatPushesTakesThemAlongWhileItTouchesThem) {
  Playground p(pool(), quiet_options());
  play(p, {"drop ball 0.16 0.3 0.08 0.08", "push 0.16 0.3 0.08 0.05 0.8 0.4 0", "frames 4"});
  const Vec3d pushed = p.simulation().collider("ball-1").twist.velocity;
  EXPECT_GT(pushed.x, 0.4);
  EXPECT_LT(pushed.x, 0.82) << "no faster than the hand";
  EXPECT_GT(pushed.y, 0) << "against its weight";
  play(p, {"release", "frames 2"});
  const Vec3d free = p.simulation().collider("ball-1").twist.velocity;
  EXPECT_NEAR(free.x, pushed.x, 0.25);
  // Two frames of free fall.
  EXPECT_NEAR(free.y, pushed.y - 9.81 * 2 / 60, 0.12);
  play(p, {"push 0.16 0.05 0.08 0.03 -2 0 0", "frames 1"});
  EXPECT_GT(p.simulation().collider("ball-1").twist.velocity.x, 0) << "the hand is elsewhere";
}

TEST(Bodies, OneThatLiesInMatterIsRefusedAndNothingIsUndone) {
  Playground p(pool(), quiet_options());
  play(p, {"frames 3", "drop ball 0.16 0.3 0.08 0.06", "refused drop crate 0.08 0.06 0.08 0.08"});
  EXPECT_THAT(p.frame()->message, HasSubstr("particles lie inside of it"));
  play(p, {"refused drop crate 0.16 0.3 0.08 0.06"});
  EXPECT_THAT(p.frame()->message, HasSubstr("inside of"));
  play(p, {"undo"});
  EXPECT_EQ(bodies(p), 0u);
  EXPECT_FALSE(p.frame()->can_undo);
}

const std::vector<std::string> busy{
    "frames 2", "drop crate 0.2 0.3 0.08 0.08", "frames 4", "drop ball 0.06 0.32 0.08 0.07", "frames 3",
    // The crate's side.
    "grab 0.2 0.24 0.08 0.05", "pull 0.26 0.3 0.08", "frames 5", "drop brick 0.12 0.34 0.08 0.06", "frames 3", "undo",
    "frames 3", "release", "frames 5"};

TEST(Bodies, RepeatThemselvesForAnyNumberOfThreads) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2}) {
    Playground p(pool(), quiet_options(threads));
    play(p, busy);
    if (threads == 1) one = p.hash();
    EXPECT_EQ(p.hash(), one);
  }
}

TEST(Bodies, AHandDragsOneAndLetsGo) {
  Playground p(pool(), quiet_options());
  play(p, {"drop crate 0.16 0.3 0.08 0.08", "grab 0.16 0.34 0.08 0.05", "pull 0.24 0.36 0.08", "frames 30"});
  EXPECT_NEAR(middle_of(p, "crate-1").x, 0.24, 0.02);
  EXPECT_GT(middle_of(p, "crate-1").y, 0.28);
  const std::uint64_t held = p.hash();
  play(p, {"release"});
  EXPECT_NE(p.hash(), held);
  play(p, {"frames 12"});
  EXPECT_LT(middle_of(p, "crate-1").y, 0.25) << "it falls";
  // A hand of the past lets go.
  play(p, {"seek 0.3", "frames 10"});
  EXPECT_LT(middle_of(p, "crate-1").y, 0.28);
}

TEST(Bodies, EraseTakesOutTheOneThatItTouches) {
  Playground p(pool(), quiet_options());
  play(p, {"drop crate 0.2 0.3 0.08 0.08", "drop ball 0.08 0.3 0.08 0.08", "erase 0.2 0.36 0.08 0.05"});
  EXPECT_EQ(bodies(p), 2u) << "near is not enough";
  play(p, {"grab 0.2 0.34 0.08 0.05", "erase 0.2 0.34 0.08 0.05", "frames 2"});
  EXPECT_EQ(bodies(p), 1u);
  EXPECT_EQ(p.frame()->bodies[0].name, "ball-2");
  play(p, {"undo", "frames 2"});
  EXPECT_EQ(bodies(p), 2u);
}

TEST(Bodies, ASavedSceneHasThem) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "play-bodies";
  std::filesystem::remove_all(folder);
  Playground p(pool(), quiet_options());
  play(p, {"drop crate 0.2 0.3 0.08 0.08", "drop brick 0.1 0.32 0.08 0.06", "frames 6",
           "save " + (folder / "tank.yaml").string()});
  const Scene saved = load_scene(folder / "tank.yaml");
  Simulation after(saved, quiet_options().simulation);
  for (const char* name : {"crate-1", "brick-2"}) {
    const ColliderState a = p.simulation().collider(name), b = after.collider(name);
    EXPECT_LT(length(a.twist.center - b.twist.center), 1e-4) << name;
    EXPECT_LT(length(a.twist.velocity - b.twist.velocity), 1e-6) << name;
    EXPECT_NEAR(a.mass, b.mass, 1e-3 * a.mass) << name;
  }
  // More can be dropped on it, under names of their own.
  Playground again(load_play_scene((folder / "tank.yaml").string()), quiet_options());
  play(again, {"frames 6", "drop crate 0.26 0.36 0.08 0.04"});
  EXPECT_EQ(bodies(again), 3u);
}

TEST(Bodies, ThePointerMeetsThem) {
  Playground p(pool(), quiet_options());
  play(p, {"set paused 1", "drop ball 0.2 0.3 0.08 0.08"});
  const std::shared_ptr<const Frame> frame = p.frame();
  const gl::Camera camera = camera_of(*frame);
  const auto seen = camera.project({0.2f, 0.3f, 0.08f}, 640, 480);
  ASSERT_TRUE(seen);
  const Hit hit = pick(*frame, camera.ray(seen->x, seen->y, 640, 480));
  EXPECT_TRUE(hit.matter);
  EXPECT_NEAR(length(hit.at - Vec3d{0.2, 0.3, 0.08}), 0.04, 2e-3) << "on its surface";
}

}  // namespace
}  // namespace dreampm::play::bodies_test
