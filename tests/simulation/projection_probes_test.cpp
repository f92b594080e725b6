// Pressure and force by the projection, where they are known: water at rest around colliders.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/run/engine.h"
#include "dreampm/scene/parse.h"
#include "scenes.h"

namespace dreampm::projection_probes_test {
namespace {
using namespace test;

constexpr double weight = 1000 * 9.81, filled = 0.24, width = 0.32;

/// Water around a collider that does not lie along the grid, in cells of 0.016 m.
std::string pool(const std::string& collider) {
  return fmt::format(
      R"(dreampm: 1
name: pool
space: {{max: [{0}, 0.352, {0}], spacing: 0.008, walls: {{all: {{type: slip}}}}}}
time: {{fps: 24, frames: 60, solver: projection}}
materials: {{water: {{type: newtonian, preset: water}}}}
colliders: {{thing: {{shape: {2}}}}}
bodies:
  water:
    material: water
    sample: {{pattern: jitter}}
    shape: {{difference: [{{box: {{min: [0, 0, 0], max: [{0}, {1}, {0}]}}}}, {2}]}}
probes:
  under: {{type: pressure, at: [0.16, 0, 0.25], normal: [0, 1, 0], radius: 0.03}}
  beside: {{type: pressure, at: [0, 0.05, 0.16], normal: [1, 0, 0], radius: 0.03}}
  over: {{type: pressure, at: [0.2, 0.3, 0.2], normal: [0, 1, 0], radius: 0.03}}
  floor: {{type: force, on: floor}}
  side: {{type: force, on: x_min}}
  thing: {{type: force, on: thing}}
)",
      width, filled, collider);
}
const std::string post = "{box: {min: [0.263, -0.1, 0.093], max: [0.296, 0.5, 0.144]}}";
const std::string ball = "{sphere: {radius: 0.106}, center: [0.127, 0.123, 0.151]}";

/// Returns the mean over the second second.
double mean(const Simulation& s, const char* probe, const char* column) {
  const ProbeSeries& series = s.probe(probe);
  const auto c = std::find(series.columns.begin(), series.columns.end(), column) - series.columns.begin();
  double sum = 0;
  int n = 0;
  for (std::size_t row = 0; row < series.rows.size(); ++row)
    if (series.time[row] > 1) sum += series.rows[row].at(static_cast<std::size_t>(c)), ++n;
  return sum / n;
}

TEST(ProjectionProbes, ReadThePressureOfWaterAtRestAndWhatItDoesToWalls) {
  Simulation s(parse_scene(pool(post), "pool.yaml"), quiet());
  s.advance_to(2);
  const auto at = [&](const char* probe, const char* column) { return mean(s, probe, column); };
  // The post stands on its part of the floor.
  const double area = width * width - 0.033 * 0.051;
  const double depth = static_cast<double>(s.particle_count()) * std::pow(0.008, 3) / area, most = weight * depth;
  // The mean over half a ball, which lies 3/8 of its radius before its flat face.
  EXPECT_NEAR(at("under", "pressure"), weight * (depth - 3.0 / 8 * 0.03), 0.005 * most);
  EXPECT_NEAR(at("beside", "pressure"), weight * (depth - 0.05), 0.005 * most);
  EXPECT_EQ(at("over", "pressure"), 0);
  EXPECT_NEAR(at("floor", "fy"), -most * area, 0.005 * most * area);
  const double side = 0.5 * most * depth * width;
  EXPECT_NEAR(at("side", "fx"), -side, 0.01 * side);
  EXPECT_NEAR(at("side", "tz"), side * depth / 3, 0.02 * side * depth / 3);
  const double pressed = 0.5 * most * depth * 0.051;  // on one side of the post
  for (const char* column : {"fx", "fy", "fz"}) EXPECT_NEAR(at("thing", column), 0, 0.02 * pressed) << column;
}

TEST(ProjectionProbes, ABallIsLiftedByWhatItDisplaces) {
  Simulation s(parse_scene(pool(ball), "pool.yaml"), quiet());
  s.advance_to(2);
  const auto at = [&](const char* column) { return mean(s, "thing", column); };
  const double lift = weight * 4 / 3 * 3.14159265 * 0.106 * 0.106 * 0.106;
  EXPECT_NEAR(at("fy"), lift, 0.02 * lift);
  for (const char* across : {"fx", "fz"}) EXPECT_NEAR(at(across), 0, 0.01 * lift) << across;
  // In its middle.
  EXPECT_NEAR(at("tz"), lift * 0.127, 0.02 * lift * 0.127);
  EXPECT_NEAR(at("tx"), -lift * 0.151, 0.02 * lift * 0.151);
}

TEST(ProjectionProbes, ParticlesHaveThePressureOfTheirDepth) {
  const scene::ParseResult parsed = scene::parse_scene_text(pool(post), "pool.yaml", {});
  ASSERT_TRUE(parsed.ok());
  const InitialState start = assemble(parsed.scene, "pool.yaml");
  Engine<float> engine(as_world<float>(start.world), make_cpu_backend());
  engine.begin(start.seeds);
  while (engine.world().frame < 25) engine.step();
  const ParticleFrame frame = particle_frame(engine.world(), engine.motion(), {}, {"pressure"}, {});
  double squares = 0;
  for (std::size_t p = 0; p < frame.position.size(); ++p) {
    const double off = static_cast<double>(frame.columns.at("pressure")[p]) -
                       weight * (filled - static_cast<double>(frame.position[p].y));
    squares += off * off;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(frame.position.size())), 0.01 * weight * filled);
}

}  // namespace
}  // namespace dreampm::projection_probes_test
