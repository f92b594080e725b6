// Sand, snow and pastes beside water in a projection: what a heap under water does, how fast grains
// settle, where snow floats.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes.h"

namespace dreampm::projection_grains_test {
namespace {
using namespace test;

constexpr double packing = 0.6;  ///< what grains are of a heap's volume

/// A box with water in it that moves by a projection, and what else there is.
Simulation box_of(const std::string& size, const std::string& rest, const std::string& spacing = "0.01",
                  int threads = 2) {
  return Simulation(
      parse_scene(fmt::format("dreampm: 1\nname: box\nspace: {{max: {}, spacing: {}, walls: {{ceiling: {{type: open}}, "
                              "floor: {{type: stick}}}}}}\ntime: {{solver: projection, fps: 24}}\n{}",
                              size, spacing, rest),
                  "box.yaml"),
      quiet(threads));
}
const std::string water_and_sand =
    "materials:\n  water: {type: newtonian, density: 1000, viscosity: 0.001}\n  sand: {type: sand, youngs_modulus: "
    "1.0e6}\n";

struct Heap {
  Vec3d middle, spread;  ///< mean of the positions, and their standard deviation [m]
  double top = 0;        ///< m, of all but 1 %
  double fastest = 0;    ///< m/s
};
Heap heap_of(const Simulation& s, const std::string& material) {
  const auto found = s.particles(material);
  Heap heap;
  std::vector<float> heights;
  const auto count = static_cast<double>(found.position.size());
  for (const Vec3f& x : found.position) {
    heap.middle += static_cast<Vec3d>(x) / count;
    heights.push_back(x.y);
  }
  for (const Vec3f& x : found.position)
    for (int a = 0; a < 3; ++a) heap.spread[a] += std::pow(static_cast<double>(x[a]) - heap.middle[a], 2) / count;
  for (int a = 0; a < 3; ++a) heap.spread[a] = std::sqrt(heap.spread[a]);
  for (const Vec3f& v : found.velocity) heap.fastest = std::max(heap.fastest, static_cast<double>(length(v)));
  std::sort(heights.begin(), heights.end());
  heap.top = static_cast<double>(heights[heights.size() * 99 / 100]);
  return heap;
}

/// A column 20 cm wide and 15 cm high, in water 24 cm deep or in none.
std::string column(bool wet) {
  const std::string sand = "  column: {material: sand, shape: {box: {min: [0.2, 0, 0], max: [0.4, 0.15, 0.08]}}}\n";
  return water_and_sand + "bodies:\n" + sand +
         (wet ? "  pool: {material: water, shape: {difference: [{box: {min: [0, 0, 0], max: [0.6, 0.24, 0.08]}}, {box: "
                "{min: [0.2, 0, 0], max: [0.4, 0.15, 0.08]}}]}, sample: {pattern: jitter}}\n"
              : "");
}

TEST(ProjectionGrains, AColumnUnderWaterSlumpsToAHeapAsADryOneDoesAndStands) {
  Simulation wet = box_of("[0.6, 0.32, 0.08]", column(true)), dry = box_of("[0.6, 0.32, 0.08]", column(false));
  const std::size_t count = wet.particle_count();
  wet.advance_to(1.25), dry.advance_to(0.75);
  const Heap heap = heap_of(wet, "sand"), in_air = heap_of(dry, "sand");
  // Water bears the grains while they slide: they go a little farther.
  EXPECT_NEAR(heap.spread.x, in_air.spread.x, 0.15 * in_air.spread.x);
  EXPECT_NEAR(heap.top, in_air.top, 0.15 * in_air.top);
  EXPECT_LT(heap.spread.x, 0.6 / std::sqrt(12.0) * 0.65) << "a liquid would lie on the whole floor";
  wet.advance_to(2);
  const Heap later = heap_of(wet, "sand");
  EXPECT_NEAR(later.middle.y, heap.middle.y, 1e-3);
  EXPECT_NEAR(later.spread.x, heap.spread.x, 2e-3) << "it creeps";
  // Water that fills the pores of the heap is missing above it.
  EXPECT_EQ(wet.particle_count(), count);
  const double level = 0.24 - (1 - packing) * 0.2 * 0.15 / 0.6;
  EXPECT_NEAR(heap_of(wet, "water").top, level, 0.02 * level);
}

TEST(ProjectionGrains, ABedUnderWaterIsStillAndItsPoresAreFull) {
  Simulation s =
      box_of("[0.2, 0.3, 0.08]",
             water_and_sand +
                 "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0.06, 0], max: [0.2, 0.2, 0.08]}}, "
                 "sample: {pattern: jitter}}\n  bed: {material: sand, shape: {box: {min: [0, 0, 0], max: [0.2, "
                 "0.06, 0.08]}}}\n");
  s.advance_to(1.5);
  double sum = 0;
  const auto found = s.particles("water");
  for (const Vec3f& v : found.velocity) sum += static_cast<double>(length2(v));
  EXPECT_LT(std::sqrt(sum / static_cast<double>(found.velocity.size())), 0.004);
  const Heap bed = heap_of(s, "sand");
  EXPECT_LT(bed.fastest, 0.006);
  EXPECT_NEAR(bed.middle.y, 0.03, 1e-3);
  // The uppermost particles lie half a spacing below.
  EXPECT_NEAR(heap_of(s, "water").top + 0.005, 0.2 - (1 - packing) * 0.06, 0.002);
}

TEST(ProjectionGrains, SandThatFallsIntoWaterSinksAndPiles) {
  Simulation s =
      box_of("[0.6, 0.5, 0.08]",
             water_and_sand +
                 "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.6, 0.18, 0.08]}}, "
                 "sample: {pattern: jitter}}\n  lump: {material: sand, shape: {box: {min: [0.22, 0.24, 0], "
                 "max: [0.38, 0.4, 0.08]}}}\n");
  s.advance_to(0.1);
  const double t = s.time();
  // Dry it falls by explicit steps, which go by half of one too far.
  EXPECT_NEAR(heap_of(s, "sand").middle.y, 0.32 - 0.5 * 9.81 * t * t, 2e-3);
  s.advance_to(2);
  const Heap heap = heap_of(s, "sand");
  EXPECT_LT(heap.middle.y, 0.06) << "it floats";
  EXPECT_GT(heap.top, 0.06) << "it lies about as a liquid does";
  EXPECT_LT(heap.fastest, 0.4);
  EXPECT_LT(s.steps(), 6u * 48);
}

TEST(ProjectionGrains, WaterThatMeetsSandKeepsItsMomentum) {
  Simulation s = box_of("[0.4, 0.4, 0.4]",
                        "gravity: [0, 0, 0]\n" + water_and_sand +
                            "bodies:\n  drop: {material: water, shape: {sphere: {radius: 0.06}, center: [0.12, 0.2, "
                            "0.2]}, velocity: [1, 0, 0], sample: {pattern: jitter}}\n  block: {material: sand, shape: "
                            "{box: {min: [0.2, 0.15, 0.15], max: [0.3, 0.25, 0.25]}}}\n");
  const Vec3d before = s.totals().momentum;
  s.advance_frames(4);
  EXPECT_GT(heap_of(s, "sand").middle.x, 0.252) << "the drop did not push it";
  EXPECT_LT(length(s.totals().momentum - before), 0.03 * length(before));
}

TEST(ProjectionGrains, ALayerThatFillsATubeSettlesAsRichardsonAndZakiSay) {
  Simulation s =
      box_of("[0.04, 0.4, 0.04]",
             water_and_sand +
                 "bodies:\n  pool: {material: water, shape: {difference: [{box: {min: [0, 0, 0], max: [0.04, "
                 "0.36, 0.04]}}, {box: {min: [0, 0.2, 0], max: [0.04, 0.28, 0.04]}}]}, sample: {pattern: "
                 "jitter}}\n  layer: {material: sand, shape: {box: {min: [0, 0.2, 0], max: [0.04, 0.28, "
                 "0.04]}}}\n");
  s.advance_to(0.25);
  const double from = heap_of(s, "sand").top, began = s.time();
  s.advance_to(0.9);
  const double to = heap_of(s, "sand").top, speed = (from - to) / (s.time() - began);
  const auto found = s.particles("sand").position;
  const auto in_upper = std::count_if(found.begin(), found.end(), [&](const Vec3f& x) {
    return static_cast<double>(x.y) < to - 0.01 && static_cast<double>(x.y) > to - 0.05;
  });
  const double grains = packing * static_cast<double>(in_upper) * 1e-6 / (0.04 * 0.04 * 0.04);
  // A grain of 1 mm by itself sinks at 0.15 m/s, in a heap at a sixteenth of it. The layer is four
  // cells high, and the outer ones read fewer grains.
  const double hindered = 0.15 * std::pow(1 - grains, 3);
  EXPECT_GT(speed, hindered);
  EXPECT_LT(speed, 3.5 * hindered);
}

TEST(ProjectionGrains, SnowFloatsWhereArchimedesSaysAndHoldsTogether) {
  Simulation s = box_of("[0.4, 0.5, 0.4]",
                        "materials:\n  water: {type: newtonian, density: 1000}\n  snow: {type: snow, density: 400}\n"
                        "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.2, 0.4]}}, "
                        "sample: {pattern: jitter}}\n  cube: {material: snow, shape: {box: {min: [0.1, 0.21, 0.1], "
                        "max: [0.3, 0.31, 0.3]}}}\n",
                        "0.0125");
  const Heap before = heap_of(s, "snow");
  s.advance_to(2);
  double y = 0;
  for (int n = 0; n < 24; ++n) s.advance_frames(1), y += heap_of(s, "snow").middle.y / 24;
  // 10 cm high, 4 of them under water. Its surface is as sharp as a cell, 2.5 cm; half of one.
  const double level = (0.2 * 0.4 * 0.4 + 0.4 * 0.2 * 0.2 * 0.1) / (0.4 * 0.4);
  EXPECT_NEAR(y, level - 0.04 + 0.05, 0.0125);
  EXPECT_NEAR(heap_of(s, "snow").spread.x, before.spread.x, 0.03 * before.spread.x);
}

TEST(ProjectionGrains, APasteSinksInWaterAndKeepsItsShape) {
  Simulation s = box_of("[0.4, 0.3, 0.2]",
                        "materials:\n  water: {type: newtonian, density: 1000}\n  paste: {type: viscoplastic, density: "
                        "1400, yield_stress: 200}\n"
                        "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.15, 0.2]}}, "
                        "sample: {pattern: jitter}}\n  lump: {material: paste, shape: {box: {min: [0.16, 0.16, 0.06], "
                        "max: [0.24, 0.24, 0.14]}}}\n");
  s.advance_to(1.5);
  const Heap lump = heap_of(s, "paste");

  EXPECT_NEAR(lump.middle.y, 0.04, 0.012);
  EXPECT_NEAR(lump.spread.x, 0.08 / std::sqrt(12.0), 0.008);
}

TEST(ProjectionGrains, TheSameBitsForAnyNumberOfThreadsAndAfterASnapshot) {
  const std::string scene =
      "materials:\n  water: {type: newtonian, density: 1000}\n  sand: {type: sand}\n  snow: {type: snow}\n"
      "bodies:\n  pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.2]}}, sample: {pattern: "
      "jitter}, cut: [post]}\n  lump: {material: sand, shape: {box: {min: [0.06, 0.12, 0.06], max: [0.14, 0.2, "
      "0.14]}}}\n  ball: {material: snow, shape: {sphere: {radius: 0.04}, center: [0.25, 0.15, 0.1]}}\n"
      "rigid: {crate: {shape: {box: {size: [0.08, 0.06, 0.08]}}, density: 400, position: [0.34, 0.14, 0.1]}}\n"
      "colliders: {post: {shape: {sphere: {radius: 0.04}, center: [0.18, 0.05, 0.1]}}}\n";
  Simulation s = box_of("[0.4, 0.4, 0.2]", scene, "0.0125", 1);
  // An edit right after what is restored, too: it begins from the velocities that are shown.
  const auto go_on = [](Simulation& of) {
    of.set_gravity({1, -9, 0});
    of.advance_frames(4);
    return of.hash();
  };
  s.advance_frames(4);
  const Snapshot then = s.snapshot();
  const std::uint64_t end = go_on(s);
  s.restore(then);
  EXPECT_EQ(go_on(s), end);
  for (const int threads : {2, 3}) {
    Simulation other = box_of("[0.4, 0.4, 0.2]", scene, "0.0125", threads);
    other.advance_frames(4);
    EXPECT_EQ(go_on(other), end) << threads;
  }
}

}  // namespace
}  // namespace dreampm::projection_grains_test
