// Foam beside the matter that is played.
#include <gtest/gtest.h>

#include <algorithm>

#include "play/small_scene.h"

namespace dreampm::play::live_foam_test {
namespace {
using namespace test;

std::size_t foam_of(Playground& p) { return p.frame()->bubbles.size() + p.frame()->foam.size(); }

/// A column of water that falls into a tank: it splashes within half a second.
PlayScene splash() { return large_step_scene(); }

/// One box of matter in the same tank.
PlayScene box_of(const std::string& material, const std::string& box, const std::string& solver) {
  return {"box", parse_scene("dreampm: 1\nname: box\nspace: {min: [0, 0, 0], max: [0.4, 0.4, 0.24], spacing: 0.02}\n"
                             "time: {fps: 60, seconds: 5, solver: " +
                                 solver + "}\nmaterials:\n  matter: {" + material +
                                 "}\nbodies:\n  box: {material: matter, shape: {box: {" + box + "}}}\n",
                             "box.yaml")};
}

TEST(LiveFoam, ASplashFoamsAndWaterAtRestDoesNot) {
  Playground p(splash(), quiet_options());
  play(p, {"set foam 1", "frames 40"});
  const std::size_t in_splash = foam_of(p);
  EXPECT_GT(in_splash, 50u);
  const Frame& frame = *p.frame();
  for (const FoamSprites* s : {&frame.bubbles, &frame.foam}) {
    ASSERT_EQ(s->radius.size(), s->size());
    ASSERT_EQ(s->color.size(), s->size());
    for (const Vec3f& x : s->position) {
      EXPECT_GT(x.y, -0.02f);
      EXPECT_LT(std::max(std::abs(x.x - 0.2f), std::abs(x.z - 0.12f)), 0.25f);
    }
  }
  Playground still(box_of("type: newtonian, preset: water", "min: [0, 0, 0], max: [0.4, 0.12, 0.24]", "projection"),
                   quiet_options());
  play(still, {"set foam 1", "frames 40"});
  EXPECT_EQ(foam_of(still), 0u);
}

TEST(LiveFoam, ItChangesNothingOfTheWorldAndIsTheSameTwice) {
  Playground with(splash(), quiet_options()), again(splash(), quiet_options()), without(splash(), quiet_options());
  play(without, {"frames 30"});
  play(with, {"set foam 1", "frames 30"});
  play(again, {"set foam 1", "frames 30"});
  EXPECT_EQ(foam_of(without), 0u);
  EXPECT_EQ(with.hash(), without.hash());
  EXPECT_EQ(with.frame()->foam.position, again.frame()->foam.position);
  EXPECT_EQ(with.frame()->foam.radius, again.frame()->foam.radius);
}

TEST(LiveFoam, ItIsGoneWhereTimeJumpsAndWhereItIsTurnedOff) {
  Playground p(splash(), quiet_options());
  play(p, {"set foam 1", "frames 40"});
  ASSERT_GT(foam_of(p), 0u);
  play(p, {"restart", "frames 1"});
  EXPECT_EQ(foam_of(p), 0u);
  play(p, {"frames 40"});
  ASSERT_GT(foam_of(p), 0u);
  play(p, {"set foam 0", "frames 1"});
  EXPECT_EQ(foam_of(p), 0u);
}

/// Jelly does not foam, whatever it does.
TEST(LiveFoam, SolidsDoNot) {
  Playground p(box_of("type: elastic, preset: jelly", "min: [0.1, 0.2, 0.08], max: [0.2, 0.3, 0.16]", "explicit"),
               quiet_options());
  play(p, {"set foam 1", "frames 25"});
  EXPECT_EQ(foam_of(p), 0u);
}

}  // namespace
}  // namespace dreampm::play::live_foam_test
