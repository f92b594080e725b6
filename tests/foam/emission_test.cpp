// What matter sends out: by its motion, and not by its spacing, the frame rate or the threads.
#include <gtest/gtest.h>

#include "dreampm/base/parallel.h"
#include "liquid.h"

namespace dreampm::test {
namespace {

const Vec3f block{0.4f, 0.2f, 0.2f};
constexpr double block_volume = 0.4 * 0.2 * 0.2;

/// Two halves that meet in the middle at 2 m/s each.
Vec3f meeting(const Vec3f& p) { return {p.x < 0.5f * block.x ? 2.0f : -2.0f, 0, 0}; }

FoamStep emitted(const Liquid& liquid, float dt, int frame, const FoamRules& rules) {
  return advance_foam({}, liquid.matter(), liquid.matter(), {}, dt, frame, rules);
}

TEST(FoamEmission, WaterAtRestEmitsNothingAndShakenWaterDoes) {
  model::Foam foam;
  foam.amount = 1000;
  const FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.02f, block_volume, foam);
  EXPECT_EQ(emitted(Liquid(block, 0.02f, at_rest), 1, 2, rules).counts.born(), 0u);
  // What settles and sloshes gently is slower than the slowest wave.
  EXPECT_EQ(
      emitted(Liquid(block, 0.02f, [](const Vec3f& p) { return Vec3f{0.2f * std::sin(40 * p.x), 0, 0}; }), 1, 2, rules)
          .counts.born(),
      0u);
  const FoamRules once = basin_rules({0.4f, 0.4f, 0.2f}, 0.02f, block_volume);
  EXPECT_GT(emitted(Liquid(block, 0.02f, meeting), 0.04f, 2, once).counts.born(), 100u);
}

TEST(FoamEmission, AtTheMeetingOfWaterAndNotBesideIt) {
  const FoamRules rules = basin_rules({0.8f, 0.4f, 0.2f}, 0.01f, block_volume);
  const FoamStep step = emitted(Liquid(block, 0.01f, meeting), 0.04f, 2, rules);
  ASSERT_GT(step.counts.trapped_air, 100u);
  EXPECT_EQ(step.counts.crest, 0u);  // nowhere does it move the way that a surface points
  std::size_t beside = 0;
  for (const Vec3f& p : step.particles.position) beside += std::fabs(p.x - 0.5f * block.x) > 2 * rules.scale;
  // The ends part from their walls.
  EXPECT_EQ(beside, 0u) << "of " << step.particles.size();
}

TEST(FoamEmission, EndsThatMeetAreNoWalls) {
  FoamRules rules = basin_rules({0.8f, 0.4f, 0.2f}, 0.01f, block_volume);
  EXPECT_GT(emitted(Liquid(block, 0.01f, meeting), 0.04f, 2, rules).counts.beside_walls, 0u) << "along z";
  rules.room.periodic[2] = true;
  const FoamCounts counts = emitted(Liquid(block, 0.01f, meeting), 0.04f, 2, rules).counts;
  EXPECT_GT(counts.born(), 100u);
  EXPECT_EQ(counts.beside_walls, 0u);
}

TEST(FoamEmission, TwiceTheFramesGiveAsMuch) {
  const FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume);
  const Liquid liquid(block, 0.01f, meeting);
  double coarse = 0, fine = 0;
  for (int f = 2; f < 12; ++f) coarse += static_cast<double>(emitted(liquid, 0.02f, f, rules).counts.born());
  for (int f = 2; f < 22; ++f) fine += static_cast<double>(emitted(liquid, 0.01f, f, rules).counts.born());
  // Each particle's count is rounded by lot: at most a half off squared, so this is far out.
  EXPECT_NEAR(fine / coarse, 1, 5 * std::sqrt(1 / coarse + 1 / fine));
}

TEST(FoamEmission, HalfTheSpacingGivesAsMuch) {
  const auto total = [](float spacing) {
    // Of a volume whose scale is more than a cell of either.
    const FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, spacing, 0.064);
    return static_cast<double>(emitted(Liquid(block, spacing, meeting), 0.05f, 2, rules).counts.born());
  };
  const double coarse = total(0.01f), fine = total(0.005f);
  EXPECT_GT(coarse, 300);
  EXPECT_NEAR(fine / coarse, 1, 0.1);
}

TEST(FoamEmission, ProportionalToTheAmount) {
  model::Foam foam;
  const auto total = [&](double amount) {
    foam.amount = amount;
    const FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume, foam);
    return static_cast<double>(emitted(Liquid(block, 0.01f, meeting), 0.1f, 2, rules).counts.born());
  };
  EXPECT_EQ(total(0), 0);
  const double one = total(1), three = total(3);
  EXPECT_NEAR(three / one, 3, 15 * std::sqrt(1 / one + 1 / three));
}

TEST(FoamEmission, HoldsTheBoundAndSaysWhatItLeftOut) {
  model::Foam foam;
  foam.most = 200;
  const FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume, foam);
  const FoamStep step = emitted(Liquid(block, 0.01f, meeting), 0.1f, 2, rules);
  EXPECT_LE(step.particles.size(), 200u);
  EXPECT_GT(step.particles.size(), 100u);
  EXPECT_GT(step.counts.thinned, 0u);
}

TEST(FoamEmission, TheSameBitsForAnyNumberOfThreads) {
  const FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume);
  const Liquid liquid(block, 0.01f, meeting), later = liquid.moved({0, 0.01f, 0});
  const auto two_frames = [&](int threads) {
    const ThreadLimit limit(threads);
    const FoamStep first = advance_foam({}, liquid.matter(), liquid.matter(), {}, 0.04f, 2, rules);
    return advance_foam(first.particles, liquid.matter(), later.matter(), {}, 0.04f, 3, rules).particles;
  };
  const FoamParticles one = two_frames(1), four = two_frames(4);
  ASSERT_GT(one.size(), 100u);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one.position[i], four.position[i]);
    EXPECT_EQ(one.radius[i], four.radius[i]);
    EXPECT_EQ(one.id[i], four.id[i]);
  }
}

TEST(FoamLimits, AreMeansOfTheFramesInWhichSomethingMoves) {
  FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume);
  const FoamMaxima still{}, fast{10, 4, 3, 100, 5};
  const std::vector<FoamMaxima> one{fast}, with_still{still, fast, still};
  EXPECT_EQ(found_limits(one, rules).speed.to, 4);
  EXPECT_EQ(found_limits(with_still, rules).speed.to, 4);
  EXPECT_EQ(found_limits(with_still, rules).trapped_air.to, 3);
  // Never below what surface tension holds together.
  EXPECT_GE(found_limits(one, rules).speed.from, 2 * slowest_wave(9.81f));
  EXPECT_NEAR(slowest_wave(9.81f), 0.231f, 1e-3f);  // Lamb, 266: 23 cm/s
}

TEST(FoamLimits, OfGrainsBeginWhereTheySplash) {
  FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume);
  rules.dust = true;
  const std::vector<FoamMaxima> slow{{10, 0.7f, 0.5f, 100, 0.4f}};
  EXPECT_NEAR(slowest_splash(9.81f), 1.98f, 5e-3f);  // 40 sqrt(g 0.25 mm)
  const FoamFound found = found_limits(slow, rules);
  EXPECT_EQ(found.speed.from, slowest_splash(9.81f));
  EXPECT_EQ(found.trapped_air.from, 2 * slowest_splash(9.81f)) << "an image comes as fast from the other side";
}

// A ball comes down on grains at rest, which have stopped it when the frame is over.
TEST(FoamEmission, GrainsAtRestSplashWhereSomethingFastComesAtThem) {
  FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume);
  rules.dust = true;
  set_limits(rules, {}, found_limits({}, rules));
  const Liquid sand(block, 0.01f, at_rest);
  const auto struck = [&](double speed, double dt) {
    Shape shape;
    shape.form = SphereShape{0.08};
    shape.center = Vec3d{0, 0, 0};
    foam::Obstacle ball;
    ball.shape = make_region(shape, 0.01, {});
    ball.bounds = ball.shape->bounds();
    ball.pose.position = {0.2, 0.26, 0.1}, ball.before.position = {0.2, 0.26 + speed * dt, 0.1}, ball.dt = dt;
    return advance_foam({}, sand.matter(), sand.matter(), {&ball, 1}, static_cast<float>(dt), 2, rules);
  };
  EXPECT_EQ(struck(1.5, 0.02).counts.born(), 0u) << "it presses";
  const FoamStep hit = struck(4, 0.02);
  ASSERT_GT(hit.counts.born(), 20u);
  for (const Vec3f& p : hit.particles.position) EXPECT_LT(std::fabs(p.x - 0.2f), 0.1f);
}

TEST(FoamLimits, GivenOnesGoBeforeFoundOnes) {
  model::Foam foam;
  foam.speed = {1, 5};
  foam.crest.limits.from = 7;
  FoamRules rules = basin_rules({0.4f, 0.4f, 0.2f}, 0.01f, block_volume);
  set_limits(rules, foam, found_limits({}, rules));
  EXPECT_EQ(rules.speed.from, 1);
  EXPECT_EQ(rules.speed.to, 5);
  EXPECT_EQ(rules.crest.from, 7);
  EXPECT_GT(rules.crest.to, 7);
  EXPECT_FALSE(limits_given(foam));
}

}  // namespace
}  // namespace dreampm::test
