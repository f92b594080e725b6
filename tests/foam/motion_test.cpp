// How spray flies, foam floats and bubbles rise.
#include "dreampm/foam/motion.h"

#include <gtest/gtest.h>

#include "liquid.h"

namespace dreampm::test {
namespace {

const Vec3f basin{0.4f, 0.8f, 0.2f};
constexpr float level = 0.4f, h = 0.01f, frame = 1 / 24.0f;

FoamRules rules_of(const model::Foam& foam = {}) { return basin_rules(basin, h, 0.4 * 0.4 * 0.2, foam); }
Liquid water() { return Liquid({basin.x, level, basin.z}, h, at_rest); }

/// The particle after `frames` frames in water at rest.
FoamParticles after(FoamParticles one, int frames, const FoamRules& rules, float dt = frame) {
  const Liquid liquid = water();
  for (int f = 2; f < 2 + frames; ++f)
    one = advance_foam(one, liquid.matter(), liquid.matter(), {}, dt, f, rules).particles;
  return one;
}

TEST(Bubble, RisesAtItsTerminalSpeedAndBecomesFoamAtTheSurface) {
  model::Foam foam;
  foam.rise = 0.2;
  const FoamRules rules = rules_of(foam);
  const FoamParticles four = after(single(FoamType::bubble, {0.2f, 0.1f, 0.1f}, {0, 0.2f, 0}), 4, rules);
  ASSERT_EQ(four.size(), 1u);
  EXPECT_NEAR(four.position[0].y, 0.1f + 0.2f * 4 * frame, 1e-5f);
  EXPECT_EQ(four.type[0], FoamType::bubble);
  EXPECT_EQ(four.life[0], 3);  // it does not age
  const FoamParticles there = after(single(FoamType::bubble, {0.2f, 0.3f, 0.1f}, {0, 0.2f, 0}), 24, rules);
  EXPECT_EQ(there.type[0], FoamType::foam);
  EXPECT_NEAR(there.position[0].y, level, h);
  EXPECT_LT(there.life[0], 3);
}

TEST(Bubble, StartsByItsOwnTimeWhateverTheFrame) {
  model::Foam foam;
  foam.rise = 0.2;
  const FoamRules rules = rules_of(foam);
  // From rest: rise (t - T (1 - exp(-t/T))), T = rise/(2 g).
  const float t = 0.02f, time = 0.2f / (2 * 9.81f), exact = 0.2f * (t - time * (1 - std::exp(-t / time)));
  const FoamParticles once = after(single(FoamType::bubble, {0.2f, 0.1f, 0.1f}), 1, rules, t);
  const FoamParticles often = after(single(FoamType::bubble, {0.2f, 0.1f, 0.1f}), 4, rules, t / 4);
  EXPECT_NEAR(once.position[0].y - 0.1f, exact, 1e-6f);
  EXPECT_NEAR(often.position[0].y - 0.1f, exact, 1e-5f);
}

TEST(Spray, FliesOnItsParabolaWithoutAir) {
  model::Foam foam;
  foam.drag = 0;
  const FoamRules rules = rules_of(foam);
  const FoamParticles one = after(single(FoamType::spray, {0.1f, 0.5f, 0.1f}, {0.5f, 1, 0}), 4, rules);
  const float t = 4 * frame;
  EXPECT_NEAR(one.position[0].x, 0.1f + 0.5f * t, 1e-5f);
  EXPECT_NEAR(one.position[0].y, 0.5f + t - 0.5f * 9.81f * t * t, 1e-5f);
  EXPECT_EQ(one.type[0], FoamType::spray);
}

TEST(Spray, FallsBackAndFloatsOnTheSurface) {
  const FoamParticles one = after(single(FoamType::spray, {0.2f, 0.5f, 0.1f}, {0, 1, 0}), 24, rules_of());
  EXPECT_EQ(one.type[0], FoamType::foam);
  EXPECT_NEAR(one.position[0].y, level, h);
}

TEST(Spray, EndsAtAWallInsideOfTheBox) {
  const Liquid liquid = water();
  const FoamRules rules = rules_of();
  const FoamStep step = advance_foam(single(FoamType::spray, {0.35f, 0.6f, 0.1f}, {4, 0, 0}), liquid.matter(),
                                     liquid.matter(), {}, frame, 2, rules);
  EXPECT_EQ(step.counts.at_walls, 1u);
  EXPECT_LE(step.particles.position[0].x, basin.x);
  EXPECT_LE(step.particles.life[0], rules.fade);
  EXPECT_EQ(after(step.particles, 14, rules).size(), 0u);  // 0.58 s later
}

TEST(Foam, GoesWithWaterThatMovesAndStaysOnIt) {
  // Up and aside by more than a cell a frame, in a box that is wide enough.
  const FoamRules rules = basin_rules({2, 2, 0.2f}, h, 0.032);
  Liquid liquid({0.4f, 0.4f, 0.2f}, h, [](const Vec3f&) { return Vec3f{1, 1, 0}; });
  FoamParticles one = single(FoamType::foam, {0.2f, level, 0.1f});
  for (int f = 2; f < 8; ++f) {
    const Liquid next = liquid.moved(Vec3f{1, 1, 0} * frame);
    one = advance_foam(one, liquid.matter(), next.matter(), {}, frame, f, rules).particles;
    liquid = next;
    // Births of the moving block's crests come after it.
    one = single(one.type[0], one.position[0], one.velocity[0], one.life[0]);
  }
  const float way = 6 * frame;
  EXPECT_EQ(one.type[0], FoamType::foam);
  EXPECT_NEAR(one.position[0].x, 0.2f + way, 0.5f * h);
  EXPECT_NEAR(one.position[0].y, level + way, h);
  EXPECT_NEAR(one.velocity[0].y, 1, 1e-3f);
}

TEST(Foam, IsPushedByAnObstacleThatMoves) {
  const Liquid liquid = water();
  const FoamRules rules = rules_of();
  SphereShape ball{0.1};
  Shape shape;
  shape.form = ball;
  shape.center = Vec3d{0, 0, 0};
  foam::Obstacle o;
  o.shape = make_region(shape, h, {});
  o.bounds = o.shape->bounds();
  o.pose.position = {0.16, level, 0.1}, o.before.position = {0.1, level, 0.1}, o.dt = frame;
  const std::vector<foam::Obstacle> obstacles{o};
  const FoamParticles one = advance_foam(single(FoamType::spray, {0.22f, 0.45f, 0.1f}), liquid.matter(),
                                         liquid.matter(), obstacles, frame, 2, rules)
                                .particles;
  EXPECT_GE(o.distance(one.position[0], 1), 0);
  EXPECT_GT(one.velocity[0].x, 0.3f);  // of the 1.44 m/s of the ball
}

TEST(Radius, ComesAndGoesWithoutALeap) {
  const FoamRules rules = rules_of();
  foam::One one;
  one.full_radius = 1;
  float before = 0;
  // Through a whole life: it grows, stays and fades.
  for (float t = 0; t < 3; t += 0.01f) {
    one.age = t, one.life = 3 - t;
    const float r = foam::drawn_radius(one, rules);
    EXPECT_LT(std::fabs(r - before), 0.16f) << t;  // smoothstep's 1.5/0.1 s
    before = r;
  }
  EXPECT_LT(before, 0.01f);
  one.age = 1, one.life = 1;
  EXPECT_EQ(foam::drawn_radius(one, rules), 1);
}

TEST(Drag, TerminalSpeedsOfDropsAreThoseMeasured) {
  // Gunn and Kinzer (1949): diameter [mm] and speed [m/s] in still air.
  for (const auto& [d, measured] : {std::pair(1.0f, 4.03f), {2.0f, 6.49f}, {3.0f, 8.06f}}) {
    float v = 5;
    for (int k = 0; k < 50; ++k) v = std::sqrt(9.81f / foam::drop_drag(0.5e-3f * d, v));
    EXPECT_NEAR(v / measured, 1, 0.1) << d;
  }
}

TEST(Drag, BubblesOfMillimetersRiseAtAQuarterOfAMeter) {
  // Clift, Grace and Weber (1978), fig. 7.3: in water, of 2 to 10 mm, 0.2 to 0.35 m/s.
  for (const float d : {2e-3f, 5e-3f, 10e-3f}) {
    EXPECT_GT(foam::bubble_speed(0.5f * d, 9.81f), 0.2f) << d;
    EXPECT_LT(foam::bubble_speed(0.5f * d, 9.81f), 0.35f) << d;
  }
}

}  // namespace
}  // namespace dreampm::test
