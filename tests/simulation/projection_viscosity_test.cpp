// Thick liquids by a projection: what they do to plates, walls and bodies, and where they slip.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes.h"

namespace dreampm::projection_viscosity_test {
namespace {
using namespace test;

constexpr double g = 9.81;

/// Returns the mean over the rows of a probe after `from` [s].
double mean(const Simulation& s, const char* probe, const char* column, double from) {
  const ProbeSeries& series = s.probe(probe);
  const auto c = std::find(series.columns.begin(), series.columns.end(), column) - series.columns.begin();
  double sum = 0;
  int n = 0;
  for (std::size_t row = 0; row < series.rows.size(); ++row)
    if (series.time[row] > from) sum += series.rows[row].at(static_cast<std::size_t>(c)), ++n;
  return sum / n;
}

/// Between plates that have no end along x and z: `gap` m of a liquid of 1000 kg/m^3, from the
/// height `from` on.
constexpr double gap = 0.1, width = 0.05;
Simulation channel(double from, double viscosity, const std::string& walls, const std::string& rest) {
  return Simulation(
      parse_scene(
          fmt::format("dreampm: 1\nname: channel\nspace: {{max: [{0}, 0.15, {0}], spacing: 0.003125, walls: "
                      "{{sides: {{type: open}}{1}}}, periodic: [x, z]}}\ntime: {{fps: 200, solver: "
                      "projection}}\nmaterials: {{liquid: {{type: newtonian, density: 1000, viscosity: {2}}}}}\n"
                      "bodies: {{liquid: {{material: liquid, shape: {{box: {{min: [0, {3}, 0], max: [{0}, {4}, "
                      "{0}]}}}}, sample: {{pattern: jitter}}}}}}\n{5}",
                      width, walls, viscosity, from, from + gap, rest),
          "channel.yaml"),
      quiet(2));
}
std::string plates(double from, const std::string& of_the_upper) {
  return fmt::format(
      "colliders:\n  low: {{type: stick, shape: {{box: {{min: [-1, -1, -1], max: [1, {}, 1]}}}}}}\n"
      "  high: {{type: stick, shape: {{box: {{min: [-1, {}, -1], max: [1, 2, 1]}}}}{}}}\n"
      "probes:\n  low: {{type: force, on: low}}\n  high: {{type: force, on: high}}\n",
      from, from + gap, of_the_upper);
}

TEST(ProjectionViscosity, APlateThatMovesIsHeldByTheLiquidAsCouetteSays) {
  for (const double from : {0.025, 0.0281}) {
    constexpr double speed = 0.1, viscosity = 280;
    Simulation s =
        channel(from, viscosity, "", "gravity: [0, 0, 0]\n" + plates(from, ", motion: {velocity: [0.1, 0, 0]}"));
    s.advance_to(0.1);
    const double drag = viscosity * speed / gap * width * width;
    EXPECT_NEAR(mean(s, "high", "fx", 0.05), -drag, 0.02 * drag) << from;
    EXPECT_NEAR(mean(s, "low", "fx", 0.05), drag, 0.02 * drag) << from;
    for (const char* across : {"fy", "fz"}) EXPECT_NEAR(mean(s, "low", across, 0.05), 0, 0.02 * drag) << across;
  }
}

TEST(ProjectionViscosity, PlatesBearWhatGravityPushesThroughBetweenThem) {
  for (const double from : {0.025, 0.0281}) {
    Simulation s = channel(from, 280, "", "gravity: [9.81, 0, 0]\n" + plates(from, ""));
    s.advance_to(0.1);
    const double push = s.totals().mass * g;
    EXPECT_NEAR(mean(s, "low", "fx", 0.05) + mean(s, "high", "fx", 0.05), push, 0.01 * push) << from;
    // Faces that a plate cuts count as whole ones: half a cell of 16 may hang on the other plate.
    EXPECT_NEAR(mean(s, "low", "fx", 0.05), push / 2, push / 32) << from;
  }
}

TEST(ProjectionViscosity, WallsBearTheWeightOfWhatFlowsDownAlongThem) {
  // A layer on the floor, whose surface is free.
  Simulation s =
      channel(0, 280, ", floor: {type: stick}", "gravity: [5, -9.81, 0]\nprobes: {floor: {type: force, on: floor}}\n");
  const double mass = s.totals().mass;
  s.advance_to(0.05);
  // Velocities belong to the middle of a step.
  double pushed = mass * 5 * (s.time() - 0.0025);
  for (const auto& row : s.probe("floor").rows) pushed -= row.at(0) * 0.005;
  EXPECT_NEAR(s.totals().momentum.x, pushed, 0.01 * mass * 5 * s.time()) << "what the floor does not take is left";
  s.advance_to(0.4);
  EXPECT_NEAR(mean(s, "floor", "fx", 0.3), mass * 5, 0.01 * mass * 5);
  EXPECT_NEAR(mean(s, "floor", "fy", 0.3), -mass * g, 0.01 * mass * g);
}

Vec3d middle_of(const Simulation& s) {
  Vec3d sum{};
  const auto found = s.particles("honey");
  for (const Vec3f& x : found.position) sum += static_cast<Vec3d>(x);
  return sum / static_cast<double>(found.position.size());
}

/// A block of honey on a plane that rises by `degrees`, along which it slips: how far it goes over
/// what it would without friction, and how far it is from the plane over where it lay.
struct Slide {
  double way, height;
};
Slide slide(double degrees, double t, const std::string& type) {
  const double angle = degrees * std::numbers::pi / 180;
  const Vec3d down{-std::cos(angle), -std::sin(angle), 0}, up{-std::sin(angle), std::cos(angle), 0};
  const Vec3d middle = Vec3d{0.45, 0.25, 0.04} + up * 0.04;
  Simulation s(
      parse_scene(
          fmt::format("dreampm: 1\nname: slide\nspace: {{max: [0.6, 0.4, 0.08], spacing: 0.005, walls: {{sides: "
                      "{{type: open}}, all: {{type: open}}}}, periodic: [z]}}\ntime: {{fps: 100, solver: "
                      "projection}}\nmaterials: {{honey: {{type: newtonian, density: 1400, viscosity: 1000}}}}\n"
                      "colliders: {{slope: {{type: {5}, shape: {{box: {{size: [3, 0.4, 3]}}, rotate: {{axis: [0, "
                      "0, 1], angle: {0}}}, center: [{1}, {2}, 0]}}}}}}\n"
                      "bodies: {{honey: {{material: honey, sample: {{pattern: jitter}}, shape: {{box: {{size: "
                      "[0.16, 0.08, 0.08]}}, rotate: {{axis: [0, 0, 1], angle: {0}}}, center: [{3}, {4}, "
                      "0.04]}}}}}}\n",
                      degrees, 0.45 - up.x * 0.2, 0.25 - up.y * 0.2, middle.x, middle.y, type),
          "slide.yaml"),
      quiet(2));
  const Vec3d start = middle_of(s);
  s.advance_to(t);
  const Vec3d gone = middle_of(s) - start;
  return {dot(gone, down) / (0.5 * g * std::sin(angle) * s.time() * s.time()), dot(gone, up)};
}

TEST(ProjectionViscosity, HoneySlidesDownASlopeThatItSlipsAlongAsFastAsItFalls) {
  for (const double degrees : {30.0, 50.0}) {
    const Slide slips = slide(degrees, 0.15, "slip");
    EXPECT_NEAR(slips.way, 1, 0.05) << degrees;
    EXPECT_NEAR(slips.height, 0, 0.002) << degrees << ", a fifth of a cell";
  }
  EXPECT_LT(slide(30, 0.15, "stick").way, 0.2);
}

TEST(ProjectionViscosity, HoneyFallsFromACeilingThatItMayLeaveAndHangsOnOneThatItSlipsAlong) {
  const auto fallen = [](const std::string& type) {
    Simulation s(
        parse_scene("dreampm: 1\nname: hang\nspace: {max: [0.2, 0.32, 0.2], spacing: 0.005}\ntime: {fps: 100, solver: "
                    "projection}\nmaterials: {honey: {type: newtonian, density: 1400, viscosity: 100}}\ncolliders: "
                    "{top: {type: " +
                        type +
                        ", shape: {box: {min: [0.02, 0.2537, 0.02], max: [0.18, 0.3, 0.18]}}}}\nbodies: {honey: "
                        "{material: honey, sample: {pattern: jitter}, shape: {box: {min: [0.05, 0.1737, 0.05], max: "
                        "[0.15, 0.2537, 0.15]}}}}\n",
                    "hang.yaml"),
        quiet(2));
    const double start = middle_of(s).y;
    s.advance_to(0.15);
    return (start - middle_of(s).y) / (0.5 * g * s.time() * s.time());
  };
  EXPECT_GT(fallen("separate"), 0.9);
  EXPECT_LT(fallen("slip"), 0.3);
}

/// How fast a ball sinks or rises in syrup along the axis of a tube that holds the syrup [m/s].
double speed_of_a_ball(const std::string& type, double density, double from, double start) {
  Simulation s(
      parse_scene(fmt::format("dreampm: 1\nname: tube\nspace: {{max: [0.2, 0.24, 0.2], spacing: 0.005, walls: {{all: "
                              "{{type: separate}}, floor: {{type: stick}}, ceiling: {{type: open}}}}}}\n"
                              "time: {{fps: 100, solver: projection}}\n"
                              "materials: {{syrup: {{type: newtonian, density: 1400, viscosity: 100}}}}\n"
                              "bodies: {{syrup: {{material: syrup, sample: {{pattern: jitter}}, shape: {{difference: "
                              "[{{cylinder: {{radius: 0.09, height: 0.22}}, center: [0.1, 0.11, 0.1]}}, {{sphere: "
                              "{{radius: 0.03}}, center: [0.1, {1}, 0.1]}}]}}}}}}\n"
                              "colliders: {{tube: {{type: stick, shape: {{difference: [{{box: {{min: [0, 0, 0], max: "
                              "[0.2, 0.24, 0.2]}}}}, {{cylinder: {{radius: 0.09, height: 0.4}}, center: [0.1, 0.1, "
                              "0.1]}}]}}}}}}\nrigid: {{ball: {{type: {2}, shape: {{sphere: {{radius: 0.03}}}}, "
                              "density: {0}, position: [0.1, {1}, 0.1]}}}}\n",
                              density, from, type),
                  "tube.yaml"),
      quiet(2));
  const auto height = [&] { return s.collider("ball").twist.center.y; };
  s.advance_to(start);
  const double at = s.time(), was = height();
  s.advance_to(start + 0.1);
  return (height() - was) / (s.time() - at);
}

TEST(ProjectionViscosity, ABallHasItsDragAtAnyDensityWhetherItHoldsOrSlips) {
  // 6 pi mu a U where it holds the syrup, 4 where that slips (Basset 1888), times what a tube three
  // times as wide makes of it (Haberman and Sayre 1958, as in validation's rigid-sphere).
  const double l = 1.0 / 3, l5 = std::pow(l, 5);
  const double holds = 6 * (1 - 0.75857 * l5) / (1 - 2.1050 * l + 2.0865 * l * l * l - 1.7068 * l5 + 0.72603 * l5 * l);
  const double slips = 4 * (1 + 1.13785 * l5) / (1 - 1.4034 * l + 1.1378 * l5 - 0.72603 * l5 * l);
  struct Ball {
    const char* type;
    double drag, density, from, start;
  };
  // Light ones have hardly left their place when the pressure has found its end.
  for (const Ball& ball : {Ball{"slip", slips, 19300, 0.14, 0.05}, Ball{"slip", slips, 5, 0.1, 0.15},
                           Ball{"stick", holds, 5, 0.1, 0.15}}) {
    const double weight = (1400 - ball.density) * g * 4 / 3 * std::numbers::pi * std::pow(0.03, 3);
    const double wanted = weight / (ball.drag * std::numbers::pi * 100 * 0.03);
    EXPECT_NEAR(speed_of_a_ball(ball.type, ball.density, ball.from, ball.start) / wanted, 1, 0.12)
        << ball.type << " " << ball.density;
  }
}

}  // namespace
}  // namespace dreampm::projection_viscosity_test
