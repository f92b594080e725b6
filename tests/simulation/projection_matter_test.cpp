// Matter beside water in a projection, against exact values: rigid bodies, viscosity, elastic
// matter, periodic axes, boxes that are full.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dreampm/base/error.h"
#include "scenes.h"

namespace dreampm::projection_matter_test {
namespace {
using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double g = 9.81;

struct Box {
  std::string size = "[0.4, 0.4, 0.4]", spacing = "0.0125", walls = "ceiling: {type: open}", space, time = ", fps: 24";
};
/// A box of water that moves by a projection, and what else there is.
Simulation box_of(const std::string& rest, const Box& box = {}) {
  return Simulation(parse_scene(fmt::format("dreampm: 1\nname: box\nspace: {{max: {}, spacing: {}, walls: {{{}}}{}}}\n"
                                            "time: {{solver: projection{}}}\n{}",
                                            box.size, box.spacing, box.walls, box.space, box.time, rest),
                                "box.yaml"),
                    quiet(2));
}
const std::string water = "materials: {water: {type: newtonian, preset: water}}\n";
std::string filled_with(const std::string& name, const std::string& shape) {
  return "bodies: {pool: {material: " + name + ", shape: " + shape + ", sample: {pattern: jitter}}}\n";
}
Vec3d middle_of(const Simulation& s, const std::string& material) {
  Vec3d sum{};
  const auto found = s.particles(material);
  for (const Vec3f& x : found.position) sum += static_cast<Vec3d>(x);
  return sum / static_cast<double>(found.position.size());
}
double fastest_of(const Simulation& s, const std::string& material) {
  double fastest = 0;
  for (const Vec3f& v : s.particles(material).velocity) fastest = std::max(fastest, static_cast<double>(length(v)));
  return fastest;
}

TEST(ProjectionBodies, ABoxFloatsAtItsDraft) {
  // It is let go 2 cells over where it floats.
  Box box;
  box.spacing = "0.01";
  Simulation s = box_of(water +
                            "bodies: {pool: {material: water, shape: {difference: [{box: {min: [0, 0, 0], max: [0.4, "
                            "0.2, 0.4]}}, {box: {size: [0.2, 0.12, 0.2]}, center: [0.2, 0.25, 0.2]}]}, sample: "
                            "{pattern: jitter}}}\nrigid: {box: {shape: {box: {size: [0.2, 0.12, 0.2]}}, density: 450, "
                            "position: [0.2, 0.25, 0.2], lock: [rx, ry, rz]}}\n",
                        box);
  const double volume = s.totals().mass / 998.2, draft = 450.0 / 998.2 * 0.12;
  s.advance_to(4);
  double height = 0;
  for (int n = 0; n < 24; ++n) s.advance_frames(1), height += s.collider("box").twist.center.y / 24;
  const double level = (volume + 0.2 * 0.2 * draft) / (0.4 * 0.4);
  EXPECT_NEAR(level - (height - 0.06), draft, 0.02 * draft);
  EXPECT_LT(length(s.collider("box").twist.velocity), 0.1);
  EXPECT_LT(s.steps(), 5u * 24 * 4);
}

TEST(ProjectionBodies, ALightBallRisesAsItsAddedMassSays) {
  for (const char* cfl : {"0.5", "2"}) {
    Box box;
    box.size = "[0.8, 0.8, 0.8]", box.spacing = "0.0125", box.time = fmt::format(", fps: 20, cfl: {}", cfl);
    Simulation s = box_of(water +
                              filled_with("water",
                                          "{difference: [{box: {min: [0, 0, 0], max: [0.8, 0.7, 0.8]}}, {sphere: "
                                          "{radius: 0.1}, center: [0.4, 0.25, 0.4]}]}") +
                              "rigid: {ball: {shape: {sphere: {radius: 0.1}}, density: 300, position: [0.4, 0.25, "
                              "0.4]}}\n",
                          box);
    s.advance_to(0.15);
    const double t = s.time(), exact = 0.5 * t * t * g * (998.2 - 300) / (300 + 0.5 * 998.2);
    const double rise = s.collider("ball").twist.center.y - 0.25;
    EXPECT_GT(rise, 0.85 * exact) << cfl;
    EXPECT_LT(rise, 1.1 * exact) << cfl;
  }
}

TEST(ProjectionBodies, ABodyAlmostWithoutMassIsStable) {
  Simulation s = box_of(water + filled_with("water", "{box: {min: [0, 0, 0], max: [0.4, 0.2, 0.4]}}") +
                        "rigid: {float: {shape: {box: {size: [0.15, 0.1, 0.15]}}, density: 5, position: [0.2, 0.3, "
                        "0.2], velocity: [0, -2, 0]}}\n");
  s.advance_to(1);
  // It rocks with every wave: what it is like on the whole counts, over a second.
  double speed = 0;
  for (int n = 0; n < 24; ++n) s.advance_frames(1), speed += length(s.collider("float").twist.velocity) / 24;
  EXPECT_NEAR(s.collider("float").twist.center.y, 0.25, 0.025) << "it lies on the water";
  EXPECT_LT(speed, 0.2);
}

TEST(ProjectionBodies, AJetBetweenTwoBodiesPushesThemApartAlike) {
  Box box;
  box.walls = "all: {type: separate}";
  Simulation s = box_of(water + "gravity: [0, 0, 0]\n" +
                            filled_with("water", "{box: {min: [0.16, 0.1, 0.14], max: [0.24, 0.3, 0.26]}}") +
                            "rigid:\n  low: {shape: {box: {size: [0.06, 0.2, 0.12]}}, density: 800, position: [0.13, "
                            "0.2, 0.2], velocity: [0.5, 0, 0]}\n"
                            "  high: {shape: {box: {size: [0.06, 0.2, 0.12]}}, density: 800, position: [0.27, 0.2, "
                            "0.2], velocity: [-0.5, 0, 0]}\n",
                        box);
  s.advance_to(0.1);
  const Vec3d low = s.collider("low").twist.velocity, high = s.collider("high").twist.velocity;
  EXPECT_LT(low.x, 0.45) << "the water did not resist";
  EXPECT_NEAR(low.x, -high.x, 0.05);
  const Totals t = s.totals();
  EXPECT_NEAR(t.momentum.x + 800 * 0.06 * 0.2 * 0.12 * (low.x + high.x), 0, 0.02 * 800 * 0.06 * 0.2 * 0.12);
}

/// The profile of a liquid between two plates, after it has come to its end: rms of the particles'
/// distance from the exact one, over its fastest.
double error_between_plates(const Simulation& s, double from, double height, double viscosity) {
  const auto found = s.particles("liquid");
  const double fastest = g * height * height / (8 * viscosity);
  double sum = 0;
  for (std::size_t p = 0; p < found.position.size(); ++p) {
    const double y = static_cast<double>(found.position[p].y) - from, exact = g / (2 * viscosity) * y * (height - y);
    sum += std::pow(static_cast<double>(found.velocity[p].x) - exact, 2);
  }
  return std::sqrt(sum / static_cast<double>(found.position.size())) / fastest;
}

TEST(ProjectionViscosity, ALiquidThatSticksToTwoPlatesHasItsProfile) {
  Box box{"[0.05, 0.1, 0.05]", "0.003125", "sides: {type: open}, floor: {type: stick}, ceiling: {type: stick}",
          ", periodic: [x, z]", ", fps: 200"};
  Simulation s =
      box_of("gravity: [9.81, 0, 0]\nmaterials: {liquid: {type: newtonian, density: 1000, viscosity: 280}}\n" +
                 filled_with("liquid", "{box: {min: [0, 0, 0], max: [0.05, 0.1, 0.05]}}"),
             box);
  s.advance_to(0.2);
  EXPECT_LT(error_between_plates(s, 0, 0.1, 0.28), 0.003);
  EXPECT_LT(s.steps(), 60u);
}

TEST(ProjectionViscosity, PlatesThatLieBetweenNodesHoldItWhereTheyAre) {
  for (const double from : {0.025, 0.0281}) {
    Box box{"[0.05, 0.15, 0.05]", "0.003125", "sides: {type: open}", ", periodic: [x, z]", ", fps: 200"};
    Simulation s = box_of(
        "gravity: [9.81, 0, 0]\nmaterials: {liquid: {type: newtonian, density: 1000, viscosity: 280}}\n" +
            filled_with("liquid",
                        fmt::format("{{box: {{min: [0, {}, 0], max: [0.05, {}, 0.05]}}}}", from, from + 0.1)) +
            fmt::format("colliders:\n  low: {{type: stick, shape: {{box: {{min: [-1, -1, -1], max: [1, {}, 1]}}}}}}\n"
                        "  high: {{type: stick, shape: {{box: {{min: [-1, {}, -1], max: [1, 2, 1]}}}}}}\n",
                        from, from + 0.1),
        box);
    s.advance_to(0.2);
    EXPECT_LT(error_between_plates(s, from, 0.1, 0.28), 0.025) << from;
  }
}

TEST(ProjectionSolids, JellyFloatsWhereArchimedesSaysAndSinksWhereItIsDenser) {
  for (const double density : {900.0, 1200.0}) {
    Box box;
    box.size = "[0.4, 0.5, 0.4]", box.spacing = "0.01";
    Simulation s = box_of(
        fmt::format("materials:\n  water: {{type: newtonian, density: 1000}}\n  jelly: {{type: elastic, density: {}, "
                    "youngs_modulus: 20000, poissons_ratio: 0.4}}\n",
                    density) +
            "bodies:\n  pool: {material: water, shape: {difference: [{box: {min: [0, 0, 0], max: [0.4, 0.2, 0.4]}}, "
            "{box: "
            "{min: [0.14, 0.08, 0.14], max: [0.26, 0.2, 0.26]}}]}, sample: {pattern: jitter}}\n  cube: {material: "
            "jelly, shape: {box: {min: [0.14, 0.08, 0.14], max: "
            "[0.26, 0.2, 0.26]}}}\n",
        box);
    s.advance_to(3);
    const double y = middle_of(s, "jelly").y;
    if (density < 1000) {
      const double volume = s.totals().mass / 1000, level = volume / (0.4 * 0.4);
      EXPECT_NEAR(y, level - 0.9 * 0.12 + 0.06, 0.004);
    } else {
      EXPECT_NEAR(y, 0.06, 0.006);
    }
    EXPECT_LT(fastest_of(s, "jelly"), 0.3);
  }
}

TEST(ProjectionSolids, DryJellyFallsAsItDoesByExplicitSteps) {
  const auto fallen = [](const std::string& solver) {
    Simulation s(
        parse_scene("dreampm: 1\nname: fall\nspace: {max: [0.3, 0.8, 0.3], spacing: 0.0125}\ntime: {fps: 24" + solver +
                        "}\nmaterials: {water: {type: newtonian, preset: water}, jelly: {type: elastic, "
                        "density: 900, youngs_modulus: 2.0e4}}\nbodies: {cube: {material: jelly, shape: {box: "
                        "{min: [0.1, 0.6, 0.1], max: [0.2, 0.7, 0.2]}}}}\n",
                    "fall.yaml"),
        quiet());
    s.advance_frames(8);
    return std::pair{middle_of(s, "jelly").y, s.time()};
  };
  const auto [large, t] = fallen(", solver: projection");
  // Explicit steps fall by half of one too far.
  EXPECT_NEAR(large, 0.65 - 0.5 * g * t * t, 4e-3);
  EXPECT_NEAR(fallen("").first, large, 1e-3);
}

TEST(ProjectionSolids, DryJellyLeavesWallsAsItDoesByExplicitSteps) {
  const auto thrown = [](const std::string& solver, const std::string& wall) {
    Simulation s(parse_scene("dreampm: 1\nname: thrown\nspace: {max: [0.4, 0.4, 0.4], spacing: 0.0125, walls: {all: "
                             "{type: " +
                                 wall + "}}}\ngravity: [0, 0, 0]\ntime: {fps: 24" + solver +
                                 "}\nmaterials: {water: {type: newtonian, preset: water}, jelly: {type: elastic, "
                                 "density: 900, youngs_modulus: 2.0e4}}\nbodies: {cube: {material: jelly, shape: {box: "
                                 "{min: [0, 0.1, 0], max: [0.1, 0.2, 0.1]}}, velocity: [0.5, 0, 0.3]}}\n",
                             "thrown.yaml"),
                 quiet());
    s.advance_frames(3);
    return middle_of(s, "jelly");
  };
  for (const char* wall : {"separate", "slip"})
    EXPECT_LT(length(thrown(", solver: projection", wall) - thrown("", wall)), 1e-3) << wall;
}

TEST(ProjectionSolids, WhatMeetsInFreeFallKeepsItsMomentum) {
  Box box;
  box.walls = "all: {type: slip}";
  Simulation s = box_of(
      "gravity: [0, 0, 0]\nmaterials:\n  water: {type: newtonian, density: 1000}\n  jelly: {type: elastic, density: "
      "1500, youngs_modulus: 20000}\n"
      "bodies:\n  drop: {material: water, shape: {sphere: {radius: 0.06}, center: [0.12, 0.2, 0.2]}, velocity: [1, 0, "
      "0], sample: {pattern: jitter}}\n  cube: {material: jelly, shape: {box: {min: [0.2, 0.15, 0.15], max: [0.3, "
      "0.25, "
      "0.25]}}}\n",
      box);
  const Vec3d before = s.totals().momentum;
  s.advance_frames(4);
  const Vec3d after = s.totals().momentum;
  EXPECT_GT(middle_of(s, "jelly").x, 0.252) << "the drop did not push it";
  EXPECT_LT(length(after - before), 0.03 * length(before));
}

TEST(ProjectionSolids, TheSameBitsForAnyNumberOfThreadsAndAfterASnapshot) {
  const std::string scene =
      "materials:\n  water: {type: newtonian, density: 1000}\n  jelly: {type: neo_hookean, density: 900, "
      "youngs_modulus: 2.0e4}\n"
      "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.4]}}, sample: {pattern: "
      "jitter}, cut: [paddle]}\n  cube: {material: jelly, shape: {box: {min: [0.1, 0.12, 0.1], max: [0.2, 0.22, "
      "0.2]}}}\n"
      "rigid: {crate: {shape: {box: {size: [0.1, 0.08, 0.1]}}, density: 400, position: [0.3, 0.16, 0.3]}}\n"
      "colliders: {paddle: {shape: {box: {size: [0.05, 0.2, 0.1]}, center: [0, 0, 0]}, motion: {keys: [{t: 0, "
      "position: [0.05, 0.1, "
      "0.2]}, "
      "{t: 0.1, position: [0.05, 0.1, 0.2]}, {t: 0.5, position: [0.15, 0.1, 0.2]}], ease: smooth}}}\n";
  Simulation s = box_of(scene);
  s.advance_frames(4);
  const Snapshot then = s.snapshot();
  s.advance_frames(4);
  const std::uint64_t end = s.hash();
  s.restore(then);
  s.advance_frames(4);
  EXPECT_EQ(s.hash(), end);
  Simulation other(parse_scene("dreampm: 1\nname: box\nspace: {max: [0.4, 0.4, 0.4], spacing: 0.0125, walls: {ceiling: "
                               "{type: open}}}\ntime: {fps: 24, solver: projection}\n" +
                                   scene,
                               "box.yaml"),
                   quiet(1));
  other.advance_frames(8);
  EXPECT_EQ(other.hash(), end);
}

TEST(ProjectionPeriodic, WhatCrossesAnEndComesInAtTheOther) {
  Box box{"[0.4, 0.4, 0.2]", "0.0125", "ceiling: {type: open}, sides: {type: open}", ", periodic: [x, z]",
          ", fps: 200"};
  Simulation s =
      box_of(water +
                 "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.2]}}, velocity: "
                 "[0.6, 0, 0.3], sample: {pattern: jitter}}}\n",
             box);
  const std::size_t count = s.particle_count();
  s.advance_to(1);
  EXPECT_EQ(s.particle_count(), count);
  const Totals t = s.totals();
  EXPECT_NEAR(t.momentum.x / t.mass, 0.6, 1e-3);
  EXPECT_NEAR(t.momentum.z / t.mass, 0.3, 1e-3);
  double highest = 0;
  for (const Vec3f& x : s.particles("water").position) {
    highest = std::max(highest, static_cast<double>(x.y));
    EXPECT_TRUE(x.x >= 0 && x.x <= 0.4F && x.z >= 0 && x.z <= 0.2F);
  }
  EXPECT_LT(highest, 0.105) << "an end is no wall";
}

TEST(ProjectionPeriodic, ABoxThatIsFullStaysStill) {
  Box box;
  box.size = "[0.2, 0.2, 0.2]", box.walls = "all: {type: slip}";
  Simulation s = box_of(water + filled_with("water", "{box: {min: [0, 0, 0], max: [0.2, 0.2, 0.2]}}"), box);
  s.advance_to(1);
  EXPECT_LT(fastest_of(s, "water"), 0.02);
  EXPECT_NEAR(middle_of(s, "water").y, 0.1, 1e-3);
}

TEST(ProjectionForces, DampingLeavesWaterItsWeight) {
  // The damped body comes to rest where the other one floats.
  Box box;
  box.time = ", fps: 24, damping: 5";
  Simulation s = box_of(
      water +
          "bodies: {pool: {material: water, shape: {difference: [{box: {min: [0, 0, 0], max: [0.4, 0.2, 0.4]}}, {box: "
          "{size: [0.2, 0.12, 0.2]}, center: [0.2, 0.2, 0.2]}]}, sample: {pattern: jitter}}}\nrigid: {box: {shape: "
          "{box: {size: [0.2, 0.12, 0.2]}}, density: 499.1, position: [0.2, 0.2, 0.2], lock: [rx, ry, rz]}}\n",
      box);
  s.advance_to(2);
  EXPECT_NEAR(s.collider("box").twist.center.y, 0.2, 1.5e-3);
}

TEST(ProjectionForces, DampingTakesItsShareOfAllMotion) {
  Box box;
  box.time = ", fps: 24, damping: 2", box.walls = "all: {type: slip}";
  Simulation s =
      box_of("gravity: [0, 0, 0]\n" + water +
                 "bodies: {drop: {material: water, shape: {sphere: {radius: 0.08}, center: [0.15, 0.2, 0.2]}, "
                 "velocity: [0.3, 0, 0], sample: {pattern: jitter}}}\n",
             box);
  s.advance_to(0.5);
  const Totals t = s.totals();
  EXPECT_NEAR(t.momentum.x / t.mass, 0.3 * std::exp(-2 * s.time()), 0.01);
}

}  // namespace
}  // namespace dreampm::projection_matter_test
