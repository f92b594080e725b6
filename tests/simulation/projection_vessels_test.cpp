// Vessels of a projection that are a few cells wide, and walls that are about as thick as a cell.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes.h"

namespace dreampm::projection_vessels_test {
namespace {
using namespace test;

constexpr double cell = 0.02, half_cell3 = 1e-6;

/// A box of cells of 0.02 m with a collider and water, and what else there is.
Simulation vessel(const std::string& collider, const std::string& water, const std::string& more = "") {
  return Simulation(parse_scene(fmt::format(R"(dreampm: 1
name: vessel
space: {{max: [0.4, 0.6, 0.4], spacing: 0.01, walls: {{ceiling: {{type: open}}}}}}
time: {{fps: 24, solver: projection}}
materials: {{water: {{type: newtonian, preset: water}}}}
colliders: {{vessel: {{shape: {}}}}}
bodies: {{water: {{material: water, shape: {}}}}}
{})",
                                            collider, water, more),
                                "vessel.yaml"),
                    quiet(2));
}
std::string box(const Vec3d& min, const Vec3d& max) {
  return fmt::format("{{box: {{min: [{}, {}, {}], max: [{}, {}, {}]}}}}", min.x, min.y, min.z, max.x, max.y, max.z);
}

struct Column {
  double height, fastest;
};
/// Returns the column of water that stood for a second.
Column stands(const std::string& hollow, const std::string& water, double area) {
  Simulation s = vessel(fmt::format("{{difference: [{}, {}]}}", box({0.1, -0.1, 0.1}, {0.3, 0.7, 0.3}), hollow), water);
  const double height = static_cast<double>(s.particle_count()) * half_cell3 / area;
  s.advance_to(1);
  const auto found = s.particles("water");
  Column c{};
  for (std::size_t p = 0; p < found.position.size(); ++p) {
    c.height += 2 * (static_cast<double>(found.position[p].y) - 0.1) / static_cast<double>(found.position.size());
    c.fastest = std::max(c.fastest, static_cast<double>(length(found.velocity[p])));
  }
  c.height /= height;
  return c;
}

TEST(ProjectionVessels, WaterStandsInTubesOfAFewCells) {
  for (const double half : {1.5 * cell, 2 * cell}) {
    const Vec3d low{0.203 - half, 0.1, 0.197 - half}, high{0.203 + half, 0.7, 0.197 + half};
    const Column c = stands(box(low, high), box(low, {high.x, 0.4, high.z}), 4 * half * half);
    EXPECT_NEAR(c.height, 1, 0.03) << half / cell;
    EXPECT_LT(c.fastest, 0.3) << half / cell;
  }
  const auto round = [](double height) {
    return fmt::format("{{cylinder: {{radius: 0.04, height: {}}}, center: [0.203, {}, 0.197]}}", height,
                       0.1 + height / 2);
  };
  const Column c = stands(round(0.8), round(0.3), std::numbers::pi * 0.04 * 0.04);
  EXPECT_NEAR(c.height, 1, 0.02);
  EXPECT_LT(c.fastest, 0.3);
}

TEST(ProjectionVessels, NothingGoesThroughAWallOfACellAndAQuarter) {
  const Vec3d low{0.083, 0.107, 0.101}, high{0.311, 0.333, 0.313}, wall{1.25 * cell, 1.25 * cell, 1.25 * cell};
  // A gravity that turns throws the falling matter about in it.
  Simulation s = vessel(fmt::format("{{difference: [{}, {}]}}", box(low - wall, high + wall), box(low, high)),
                        box({0.09, 0.2, 0.11}, {0.2, 0.32, 0.3}), "");
  for (int n = 0; n < 8; ++n) {
    const double turn = 2.4 * n;
    s.set_gravity({15 * std::sin(turn), -15 * std::cos(turn), 5 * std::sin(1.7 * turn)});
    s.advance_frames(4);
  }
  for (const Vec3f& x : s.particles("water").position)
    for (int a = 0; a < 3; ++a) {
      EXPECT_GT(static_cast<double>(x[a]), low[a] - 1e-3);
      EXPECT_LT(static_cast<double>(x[a]), high[a] + 1e-3);
    }
}

TEST(ProjectionVessels, APlateOfACellAndAQuarterPushesAllBeforeIt) {
  // From 0.05 m to 0.25 m and back: with the box it is a piston.
  Simulation s = Simulation(parse_scene(R"(dreampm: 1
name: piston
space: {max: [0.4, 0.6, 0.4], spacing: 0.01, walls: {ceiling: {type: open}}}
time: {fps: 24, solver: projection}
materials: {water: {type: newtonian, preset: water}}
bodies: {water: {material: water, shape: {box: {min: [0.07, 0, 0], max: [0.4, 0.15, 0.4]}}}}
colliders:
  plate:
    shape: {box: {size: [0.025, 1, 0.5]}, center: [0, 0, 0]}
    motion: {keys: [{t: 0, position: [0.053, 0.3, 0.2]}, {t: 0.25, position: [0.251, 0.3, 0.2]}, {t: 0.6, position: [0.15, 0.3, 0.2]}]}
)",
                                        "piston.yaml"),
                            quiet(2));
  for (const auto& [time, place] : {std::pair{0.25, 0.251}, {0.6, 0.15}}) {
    s.advance_to(time);
    std::size_t behind = 0;
    for (const Vec3f& x : s.particles("water").position) behind += static_cast<double>(x.x) < place ? 1 : 0;
    EXPECT_EQ(behind, 0u) << time;
  }
}

TEST(ProjectionVessels, AStickyCeilingHoldsWaterThatIsNotTooHeavy) {
  for (const double tension : {250.0, 1500.0}) {  // its weight is 590 Pa
    Simulation s = Simulation(parse_scene(fmt::format(R"(dreampm: 1
name: ceiling
space: {{max: [0.4, 0.5, 0.4], spacing: 0.01, walls: {{all: {{type: slip}}}}}}
time: {{fps: 24, solver: projection}}
materials: {{water: {{type: newtonian, preset: water}}}}
bodies: {{water: {{material: water, shape: {{box: {{min: [0, 0.29, 0], max: [0.4, 0.35, 0.4]}}}}}}}}
colliders: {{plate: {{shape: {{box: {{min: [0, 0.35, 0], max: [0.4, 0.5, 0.4]}}}}, sticky: {}}}}}
)",
                                                      tension),
                                          "ceiling.yaml"),
                              quiet(2));
    s.advance_to(0.25);
    double height = 0;
    const auto found = s.particles("water");
    for (const Vec3f& x : found.position)
      height += static_cast<double>(x.y) / static_cast<double>(found.position.size());
    if (tension > 590)
      EXPECT_NEAR(height, 0.32, 0.025) << "it drips";
    else
      EXPECT_LT(height, 0.12);
  }
}

TEST(ProjectionVessels, WhatIsInATipStaysInIt) {
  // Two boxes that are turned against one another: an edge of 24 degrees, which narrows to nothing.
  const auto hollow = [](double grown) {
    std::string both = "{intersection: [";
    for (const double turn : {-12.0, 12.0})
      both += fmt::format("{{box: {{size: [{}, {}, {}]}}, rotate: {{axis: z, angle: {}}}, center: [{}, 0.3, 0.2]}}, ",
                          0.12 + 2 * grown, 0.5 + 2 * grown, 0.2 + 2 * grown, turn, 0.2 + 0.004 * turn);
    return both + "]}";
  };
  Simulation s = vessel(fmt::format("{{difference: [{}, {}]}}", hollow(1.5 * cell), hollow(0)),
                        "{sphere: {radius: 0.03}, center: [0.2, 0.38, 0.2]}");
  const std::size_t count = s.particle_count();
  ASSERT_GT(count, 100u);
  s.advance_to(2);
  const auto found = s.particles("water");
  for (const Vec3f& x : found.position) EXPECT_GT(x.y, 0.05f);
  // Liquid that is held there does not gather speed.
  for (const Vec3f& v : found.velocity) EXPECT_LT(length(v), 1.0f);
}

TEST(ProjectionVessels, StillWaterLiftsAPlateAskewAndPushesItNowhere) {
  const std::string plate =
      "{box: {size: [0.13, 0.07, 0.11]}, rotate: {axis: [1, 2, -1.5], angle: 25}, center: [0.207, 0.171, 0.193]}";
  Simulation s = vessel(plate, fmt::format("{{difference: [{}, {}]}}", box({0, 0, 0}, {0.4, 0.32, 0.4}), plate),
                        "probes: {force: {type: force, on: vessel}}");
  s.advance_to(2);
  const ProbeSeries& series = s.probe("force");
  Vec3d force{};
  double n = 0;
  for (std::size_t row = 0; row < series.rows.size(); ++row) {
    if (series.time[row] < 1) continue;
    for (int a = 0; a < 3; ++a) {
      const auto c = std::find(series.columns.begin(), series.columns.end(), std::string("f") + "xyz"[a]);
      force[a] += series.rows[row].at(static_cast<std::size_t>(c - series.columns.begin()));
    }
    ++n;
  }
  force = force / n;
  const double displaced = 998.2 * 9.81 * 0.13 * 0.07 * 0.11;
  EXPECT_NEAR(force.y, displaced, 0.02 * displaced);
  EXPECT_NEAR(force.x, 0, 0.01 * displaced);
  EXPECT_NEAR(force.z, 0, 0.01 * displaced);
}

}  // namespace
}  // namespace dreampm::projection_vessels_test
