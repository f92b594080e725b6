// Pressure and force by the projection, where they are known: water at rest around colliders.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/scene/parse.h"
#include "dreampm/simulation/engine.h"
#include "dreampm/simulation/frames.h"
#include "scenes.h"

namespace dreampm::projection_probes_test {
namespace {
using namespace test;

constexpr double weight = 1000 * 9.81, depth = 0.24, width = 0.32;

/// Water around a ball that it covers and a post that stands in it, none of them along the grid.
const std::string pool = fmt::format(
    R"(dreampm: 1
name: pool
space: {{max: [{0}, 0.36, {0}], spacing: 0.01, walls: {{all: {{type: slip}}}}}}
time: {{fps: 24, frames: 60, solver: projection}}
materials: {{water: {{type: newtonian, preset: water}}}}
colliders:
  ball: {{shape: {{sphere: {{radius: 0.07}}, center: [0.103, 0.127, 0.151]}}}}
  post: {{shape: {{box: {{min: [0.233, -0.1, 0.093], max: [0.266, 0.5, 0.144]}}}}}}
bodies:
  water:
    material: water
    sample: {{pattern: jitter}}
    shape: {{difference: [{{box: {{min: [0, 0, 0], max: [{0}, {1}, {0}]}}}}, {{sphere: {{radius: 0.07}}, center: [0.103, 0.127, 0.151]}}, {{box: {{min: [0.233, -0.1, 0.093], max: [0.266, 0.5, 0.144]}}}}]}}
probes:
  under: {{type: pressure, at: [0.16, 0, 0.25], normal: [0, 1, 0], radius: 0.03}}
  beside: {{type: pressure, at: [0, 0.05, 0.16], normal: [1, 0, 0], radius: 0.03}}
  over: {{type: pressure, at: [0.2, 0.3, 0.2], normal: [0, 1, 0], radius: 0.03}}
  floor: {{type: force, on: floor}}
  side: {{type: force, on: x_min}}
  ball: {{type: force, on: ball}}
  post: {{type: force, on: post}}
)",
    width, depth);

double mean(const ProbeSeries& series, const std::string& column, double from) {
  const auto c = static_cast<std::size_t>(std::find(series.columns.begin(), series.columns.end(), column) -
                                          series.columns.begin());
  double sum = 0;
  int n = 0;
  for (std::size_t row = 0; row < series.rows.size(); ++row)
    if (series.time[row] > from) sum += series.rows[row].at(c), ++n;
  return sum / n;
}

TEST(ProjectionProbes, ReadThePressureAndTheForcesOfWaterAtRest) {
  Simulation s(parse_scene(pool, "pool.yaml"), quiet());
  s.advance_to(2);
  const auto at = [&](const char* probe, const char* column) { return mean(s.probe(probe), column, 1); };
  // The mean over half a ball, which lies 3/8 of its radius before its flat face.
  EXPECT_NEAR(at("under", "pressure"), weight * (depth - 3.0 / 8 * 0.03), 0.005 * weight * depth);
  EXPECT_NEAR(at("beside", "pressure"), weight * (depth - 0.05), 0.005 * weight * depth);
  EXPECT_EQ(at("over", "pressure"), 0);
  // The post stands on its part of the floor.
  const double area = width * width - 0.033 * 0.051;
  EXPECT_NEAR(at("floor", "fy"), -weight * depth * area, 0.005 * weight * depth * area);
  const double side = 0.5 * weight * depth * depth * width;
  EXPECT_NEAR(at("side", "fx"), -side, 0.01 * side);
  EXPECT_NEAR(at("side", "tz"), side * depth / 3, 0.02 * side * depth / 3);
  const double lift = weight * 4 / 3 * 3.14159265 * 0.07 * 0.07 * 0.07;
  EXPECT_NEAR(at("ball", "fy"), lift, 0.02 * lift);
  for (const char* across : {"fx", "fz"}) EXPECT_NEAR(at("ball", across), 0, 0.02 * lift);
  // It acts at the ball's middle.
  EXPECT_NEAR(at("ball", "tz"), lift * 0.103, 0.02 * lift * 0.103);
  EXPECT_NEAR(at("ball", "tx"), -lift * 0.151, 0.02 * lift * 0.151);
  const double pressed = 0.5 * weight * depth * depth * 0.051;  // on one side of the post
  for (const char* column : {"fx", "fy", "fz"}) EXPECT_NEAR(at("post", column), 0, 0.02 * pressed) << column;
}

TEST(ProjectionProbes, ParticlesHaveThePressureOfTheirDepth) {
  const scene::ParseResult parsed = scene::parse_scene_text(pool, "pool.yaml", {});
  ASSERT_TRUE(parsed.ok());
  const InitialState start = assemble(parsed.scene, "pool.yaml");
  Engine<float> engine(as_world<float>(start.world), make_cpu_backend());
  engine.begin(start.seeds);
  while (engine.world().frame < 25) engine.step();
  const ParticleFrame frame = particle_frame(engine.world(), engine.motion(), {}, {"pressure"}, {});
  double squares = 0;
  for (std::size_t p = 0; p < frame.position.size(); ++p) {
    const double off = static_cast<double>(frame.columns.at("pressure")[p]) -
                       weight * (depth - static_cast<double>(frame.position[p].y));
    squares += off * off;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(frame.position.size())), 0.01 * weight * depth);
}

}  // namespace
}  // namespace dreampm::projection_probes_test
