// Rigid bodies: alone, among each other, and in water.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;

/// `matter`: a drop far away, for a scene needs some.
std::string with_bodies(const std::string& rigid, const std::string& gravity = "[0, -9.81, 0]",
                        const std::string& size = "[2, 2, 2]", const std::string& apart = "0.05",
                        const std::string& matter = "{box: {min: [1.8, 0, 1.8], max: [2, 0.1, 2]}}") {
  return "dreampm: 1\nname: rigid\nspace: {min: [0, 0, 0], max: " + size + ", spacing: " + apart +
         "}\ntime: {fps: 50}\ngravity: " + gravity +
         "\nmaterials: {water: {type: newtonian, preset: water}}\nbodies: {drop: {material: water, shape: " + matter +
         "}}\nrigid: {" + rigid + "}\n";
}

TEST(Rigid, FallsAndTurnsFreely) {
  Simulation s(parse_scene(with_bodies("ball: {shape: {box: {size: [0.3, 0.2, 0.1]}}, mass: 2, position: [0.5, 1.5, "
                                       "0.5], velocity: [0.3, 0, 0], spin: [0, 0, 2]}"),
                           "fall.yaml"),
               quiet());
  s.advance_to(0.3);
  const ColliderState state = s.collider("ball");
  EXPECT_NEAR(state.twist.velocity.y, -9.81 * s.time(), 1e-9);
  EXPECT_NEAR(state.twist.center.x, 0.5 + 0.3 * s.time(), 1e-9);
  // A symplectic step falls g t dt/2 further.
  EXPECT_NEAR(state.twist.center.y, 1.5 - 0.5 * 9.81 * s.time() * s.time(), 0.02);
  EXPECT_NEAR(2 * std::atan2(state.pose.rotation.z, state.pose.rotation.w), 2 * s.time(), 1e-6);
}

// Free rotation about the middle axis is not stable; energy and angular momentum stay.
TEST(Rigid, KeepsAngularMomentumWhenItTumbles) {
  Simulation s(
      parse_scene(with_bodies("plate: {shape: {box: {size: [0.4, 0.2, 0.05]}}, density: 1000, position: [1, 1, "
                              "1], spin: [0.05, 4, 0.05]}",
                              "[0, 0, 0]"),
                  "tumble.yaml"),
      quiet());
  const double m = 1000 * 0.4 * 0.2 * 0.05;
  const Vec3d inertia = Vec3d{0.2 * 0.2 + 0.05 * 0.05, 0.4 * 0.4 + 0.05 * 0.05, 0.4 * 0.4 + 0.2 * 0.2} * (m / 12);
  const auto angular = [&] {
    const ColliderState state = s.collider("plate");
    return state.pose.rotation(inertia * state.pose.rotation.inverse()(state.twist.spin));
  };
  const Vec3d before = angular();
  s.advance_to(1.5);
  std::printf("angular momentum %.4g before, off by %.2g\n", length(before), length(angular() - before));
  EXPECT_LT(length(angular() - before), 0.03 * length(before));
}

TEST(Rigid, RestsOnTheFloorAndOnOthers) {
  Simulation s(parse_scene(with_bodies("low: {shape: {box: {size: [0.4, 0.2, 0.4]}}, density: 500, position: [0.5, "
                                       "0.15, 0.5]}, high: {shape: {box: {size: [0.2, 0.2, 0.2]}}, density: 2000, "
                                       "position: [0.5, 0.4, 0.5]}"),
                           "stack.yaml"),
               quiet());
  s.advance_to(1.5);
  EXPECT_NEAR(s.collider("low").twist.center.y, 0.1, 0.005);
  EXPECT_NEAR(s.collider("high").twist.center.y, 0.3, 0.01);
  EXPECT_LT(length(s.collider("high").twist.velocity), 2e-3);
  EXPECT_LT(length(s.collider("low").twist.velocity), 2e-3);
}

TEST(Rigid, FrictionStopsWhatSlides) {
  Simulation s(
      parse_scene(with_bodies("box: {shape: {box: {size: [0.2, 0.2, 0.2]}}, density: 500, position: [0.3, 0.1, "
                              "0.5], velocity: [1.5, 0, 0], friction: 0.3}"),
                  "slide.yaml"),
      quiet());
  s.advance_to(1);
  const double way = 1.5 * 1.5 / (2 * 0.3 * 9.81);
  EXPECT_NEAR(s.collider("box").twist.center.x - 0.3, way, 0.05 * way);
  EXPECT_LT(length(s.collider("box").twist.velocity), 5e-3);
}

/// A box of `density` over a pool; `apart`: spacing. 4 cells high at 0.015.
std::string floating(double density, const std::string& apart) {
  return with_bodies("crate: {shape: {box: {size: [0.18, 0.12, 0.18]}}, density: " + std::to_string(density) +
                         ", position: [0.24, 0.3, 0.24]}",
                     "[0, -9.81, 0]", "[0.48, 0.6, 0.48]", apart, "{box: {min: [0, 0, 0], max: [0.48, 0.24, 0.48]}}");
}

// A floating box lies as deep as its density says, and comes to rest.
TEST(Rigid, FloatsByItsDensity) {
  for (const double density : {100.0, 800.0}) {
    Simulation s(parse_scene(floating(density, "0.015"), "float.yaml"), quiet(2));
    s.advance_to(1.2);
    double mean = 0;
    int samples = 0;
    for (; s.time() < 1.6; ++samples) {
      s.advance_frames(1);
      mean += s.collider("crate").twist.center.y;
    }
    mean /= samples;
    // The level of the water with what the crate displaces.
    const double displaced = density / 998.2 * 0.18 * 0.12 * 0.18;
    const double level = (0.24 * 0.48 * 0.48 + displaced) / (0.48 * 0.48);
    const double draft = level - (mean - 0.06);
    std::printf("density %.0f: draft %.4f m of %.4f m, speed %.2g m/s\n", density, draft, density / 998.2 * 0.12,
                length(s.collider("crate").twist.velocity));
    EXPECT_NEAR(draft, density / 998.2 * 0.12, 0.1 * 0.12) << density;
    EXPECT_LT(length(s.collider("crate").twist.velocity), 0.1) << density;
  }
}

// Whatever the ratio of densities nothing blows up: a float lies still, and steel comes to rest on
// the floor.
TEST(Rigid, LightAndHeavyBodiesStayCalm) {
  for (const double density : {20.0, 7800.0}) {
    Simulation s(parse_scene(floating(density, "0.02"), "ratio.yaml"), quiet(2));
    s.advance_to(1);
    double fastest = 0;
    s.on_step([&](const StepReport& r) { fastest = std::max(fastest, r.max_speed); });
    s.advance_to(1.2);
    const ColliderState state = s.collider("crate");
    std::printf("density %.0f: at %.3f m, %.2g m/s; water at most %.2g m/s\n", density, state.twist.center.y,
                length(state.twist.velocity), fastest);
    EXPECT_LT(fastest, 2) << density;
    EXPECT_LT(length(state.twist.velocity), 0.2) << density;
    if (density > 1000)
      EXPECT_NEAR(state.twist.center.y, 0.06, 0.01);
    else
      EXPECT_GT(state.twist.center.y, 0.27);
  }
}

// Momentum that water gains a body loses: without gravity only walls, which are far, change the
// sum.
TEST(Rigid, MomentumOfWaterAndBodyIsConserved) {
  Simulation s(parse_scene(with_bodies("brick: {shape: {box: {size: [0.12, 0.12, 0.12]}}, density: 2000, position: "
                                       "[0.16, 0.3, 0.3], velocity: [1, 0, 0], spin: [0, 3, 0]}",
                                       "[0, 0, 0]", "[0.9, 0.6, 0.6]", "0.015",
                                       "{box: {min: [0.3, 0.15, 0.15], max: [0.6, 0.45, 0.45]}}"),
                           "throw.yaml"),
               quiet());
  const double mass = 2000 * 0.12 * 0.12 * 0.12;
  const auto sum = [&] { return s.totals().momentum + s.collider("brick").twist.velocity * mass; };
  const Vec3d before = sum();
  s.advance_to(0.25);
  EXPECT_GT(s.totals().momentum.x, 0.3);
  std::printf("momentum off by %.3g of %.3g N s\n", length(sum() - before), length(before));
  EXPECT_LT(length(sum() - before), 1e-4 * length(before));
}

TEST(Rigid, BitsDoNotDependOnThreadsOrRestarts) {
  expect_same_bits(parse_scene(floating(400, "0.02"), "float.yaml"), 0.1, 0.25);
}

// A ball on a spring, in empty space: it swings with the period of its mass, and damping takes half
// of its amplitude in ln 2 * 2 m / c.
TEST(Rigid, SwingsOnASpring) {
  const double mass = 2, stiffness = 200, period = 2 * std::numbers::pi * std::sqrt(mass / stiffness);
  for (const double damping : {0.0, 4.0}) {
    std::string text = with_bodies(
        "bob: {shape: {sphere: {radius: 0.1}}, mass: 2, position: [1.2, 1, 1], spring: {to: "
        "[1, 1, 1], stiffness: 200, damping: " +
            std::to_string(damping) + "}}",
        "[0, 0, 0]");
    text.replace(text.find("{fps: 50}"), 9, "{fps: 50, dt_max: 0.004}");
    Simulation s(parse_scene(text, "spring.yaml"), quiet());
    std::vector<double> crossings;
    double before = 0.2, largest = 0;
    while (s.time() < 5.2 * period) {
      const double time = s.time();
      s.step();
      const double now = s.collider("bob").twist.center.x - 1;
      if (before > 0 && now <= 0) crossings.push_back(time + (s.time() - time) * before / (before - now));
      if (s.time() > 4.5 * period) largest = std::max(largest, std::abs(now));
      before = now;
    }
    ASSERT_GE(crossings.size(), 5u);
    const double swings = (crossings[4] - crossings[0]) / 4, rate = damping / (2 * mass);
    std::printf("damping %g: period %.5f s of %.5f s, amplitude %.4f m\n", damping, swings, period, largest);
    EXPECT_NEAR(swings, 2 * std::numbers::pi / std::sqrt(stiffness / mass - rate * rate), 0.01 * period);
    EXPECT_NEAR(largest, 0.2 * std::exp(-rate * 5 * period), 0.02 * 0.2);
  }
}

// A pin holds matter; a body falls through it.
TEST(Rigid, PassesPins) {
  const std::string ball = with_bodies("ball: {shape: {sphere: {radius: 0.1}}, density: 500, position: [0.5, 1, 0.5]}");
  Simulation free(parse_scene(ball, "pin.yaml"), quiet()),
      pinned(parse_scene(ball + "pins: {grip: {shape: {box: {size: [0.4, 0.2, 0.4]}, center: [0.5, 0.85, 0.5]}}}\n",
                         "pin.yaml"),
             quiet());
  free.advance_to(0.3), pinned.advance_to(0.3);
  EXPECT_LT(free.collider("ball").twist.center.y, 0.7);
  EXPECT_NEAR(pinned.collider("ball").twist.center.y, free.collider("ball").twist.center.y, 1e-9);
}

TEST(Rigid, LockedAxesStay) {
  Simulation s(parse_scene(with_bodies("bob: {shape: {sphere: {radius: 0.1}}, density: 500, position: [0.5, 1, 0.5], "
                                       "velocity: [1, 0, 1], lock: [x, ry]}"),
                           "lock.yaml"),
               quiet());
  s.advance_to(0.2);
  EXPECT_NEAR(s.collider("bob").twist.center.x, 0.5, 1e-12);
  EXPECT_GT(s.collider("bob").twist.center.z, 0.6);
}

TEST(Rigid, BodiesInsideOfOthersAreRefused) {
  const auto refused = [](const std::string& rigid) {
    return refusal([&] { Simulation(parse_scene(with_bodies(rigid), "rigid.yaml"), quiet()); });
  };
  const std::string a = "a: {shape: {box: {size: [0.4, 0.4, 0.4]}}, density: 500, position: [0.5, 0.5, 0.5]}";
  EXPECT_THAT(refused(a + ", b: {shape: {sphere: {radius: 0.2}}, density: 500, position: [0.8, 0.5, 0.5]}"),
              HasSubstr("rigid body a starts"));
  EXPECT_THAT(refused("a: {shape: {sphere: {radius: 0.1}}, position: [0.5, 0.5, 0.5]}"),
              HasSubstr("give either a density or a mass"));
  EXPECT_THAT(refused("a: {shape: {sphere: {radius: 0.1}}, density: 0, position: [0.5, 0.5, 0.5]}"),
              HasSubstr("rigid.a.density is 0"));
  EXPECT_THAT(refused("a: {shape: {sphere: {radius: 0.1}}, density: 500, position: [0.05, 0.5, 0.5]}"),
              HasSubstr("rigid body a reaches 0.05 m outside the wall x_min"));
}

}  // namespace
}  // namespace dreampm
