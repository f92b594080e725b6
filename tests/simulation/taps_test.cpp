// Taps that something solid covers, that are alone in a scene, and that move.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/scene/parse.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::string tap_room(const std::string& more) {
  return "dreampm: 1\nname: tap\nspace: {max: [0.6, 0.4, 0.2], spacing: 0.02, walls: {ceiling: {type: open}}}\n"
         "time: {fps: 24, frames: 60}\n"
         "materials: {water: {type: newtonian, preset: water, max_compression: 0.03}}\n" +
         more;
}
std::string tap(const std::string& more = "") {
  return "emitters: {tap: {material: water, shape: {box: {min: [0.28, 0.22, 0.06], max: [0.36, 0.28, 0.14]}}, "
         "velocity: "
         "[0, -0.5, 0], pool: 50000" +
         more + "}}\n";
}
Simulation of(const std::string& text) { return Simulation(parse_scene(text, "tap.yaml"), quiet()); }

std::size_t within(const Simulation& s, const Vec3d& low, const Vec3d& high) {
  const ParticleView view = s.particles("water");
  return static_cast<std::size_t>(std::count_if(view.position.begin(), view.position.end(), [&](const Vec3f& p) {
    return p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y && p.z > low.z && p.z < high.z;
  }));
}

// A block slides over a tap and encloses it; when it has gone on, the tap gives again.
TEST(Taps, GiveNothingInsideOfABlockThatSlidesOverThem) {
  Simulation s = of(
      tap_room(tap() + "colliders: {block: {shape: {box: {min: [0.02, 0.14, 0.02], max: [0.2, 0.36, 0.18]}}, motion: "
                       "{keys: [{t: 0.1}, {t: 0.4, position: [0.21, 0, 0]}, {t: 0.8, position: [0.21, 0, 0]}, {t: 1.1, "
                       "position: [0, 0, 0]}]}}}\n"));
  s.advance_to(0.1);
  EXPECT_GT(s.particle_count(), 0u);
  s.advance_to(0.42);
  const std::size_t covered = s.particle_count();
  s.advance_to(0.75);
  EXPECT_EQ(s.particle_count(), covered);
  EXPECT_EQ(within(s, {0.27, 0.18, 0.06}, {0.37, 0.32, 0.14}), 0u) << "in the block";
  s.advance_to(1.3);
  EXPECT_GT(s.particle_count(), covered + 50);
}

TEST(Taps, GiveNothingInsideOfALidThatAProgramPutThere) {
  for (const bool rigid : {false, true}) {
    Simulation s = of(tap_room(tap()));
    s.advance_to(0.1);
    s.remove(Shape::box({0, 0, 0}, {0.6, 0.4, 0.2}));
    const auto lid = Shape::box({0.22, 0.16, 0.02}, {0.42, 0.34, 0.18});
    if (rigid) {
      model::Collider body{"lid", lid};
      body.rigid = {.density = 500};
      s.add(body);
      s.attach("lid", {{0.32, 0.25, 0.1}, {0.32, 0.25, 0.1}, 1e5, 1e3});
    } else {
      s.add({"lid", lid});
    }
    s.advance_to(0.4);
    EXPECT_EQ(s.particle_count(), 0u) << rigid;
  }
}

TEST(Taps, AProgramIsToldOfParticlesThatItPutsIntoASolid) {
  Simulation s =
      of(tap_room(tap() + "colliders: {block: {shape: {box: {min: [0.02, 0.1, 0.02], max: [0.2, 0.3, 0.18]}}}}\n"));
  const std::vector<Vec3d> places{{0.1, 0.2, 0.1}, {0.4, 0.2, 0.1}};
  EXPECT_THAT([&] { s.add_particles("water", places, {}); },
              ThrowsMessage<InputError>(HasSubstr("1 of 2 particles lie inside of collider block")));
  s.add_particles("water", std::vector<Vec3d>{{0.4, 0.2, 0.1}}, {});
}

// The first matter of an empty scene is moved by the step that was chosen before it came.
TEST(Taps, TheFirstStepOfALoneTapSuitsWhatComes) {
  for (const char* start : {"", ", start: 0.1"}) {
    Simulation s = of(
        tap_room(tap(start) + "colliders: {plate: {shape: {box: {min: [0.2, 0, 0.02], max: [0.44, 0.22, 0.18]}}}}\n"));
    double fastest = 0;
    while (s.time() < 0.25) {
      s.step();
      for (const Vec3f& v : s.particles("water").velocity) fastest = std::max(fastest, double(length(v)));
    }
    EXPECT_GT(s.particle_count(), 100u);
    EXPECT_LT(fastest, 3) << start;
  }
}

/// Without gravity, so that what came in goes on as it came.
Simulation drifting(const std::string& motion) {
  return of(tap_room("gravity: [0, 0, 0]\n" + tap(", motion: " + motion)));
}

// Matter that comes in has the velocity of the shape besides its own, and comes in at the shape's
// place.
TEST(Taps, ThatMoveGiveWhereTheyAre) {
  Simulation s = drifting("{velocity: [-0.8, 0, 0]}");
  s.advance_to(0.2);
  const ParticleView view = s.particles("water");
  ASSERT_GT(view.size(), 100u);
  float low = 1;
  for (std::size_t i = 0; i < view.size(); ++i) {
    EXPECT_NEAR(view.velocity[i].x, -0.8, 0.05);
    EXPECT_NEAR(view.velocity[i].y, -0.5, 0.05);
    low = std::min(low, view.position[i].x);
  }
  EXPECT_NEAR(low, 0.28 - 0.8 * 0.2 + 0.01, 0.012);
  // The amount is that of a tap that stands.
  Simulation still = of(tap_room("gravity: [0, 0, 0]\n" + tap()));
  still.advance_to(0.2);
  EXPECT_NEAR(double(view.size()), double(still.particle_count()), 0.02 * double(still.particle_count()));
}

TEST(Taps, ThatTurnGiveInTheDirectionThatTheyHave) {
  Simulation s = drifting("{keys: [{t: 0, rotate: {axis: [0, 0, 1], angle: 90}}]}");
  s.advance_to(0.1);
  const ParticleView view = s.particles("water");
  ASSERT_GT(view.size(), 50u);
  for (const Vec3f& v : view.velocity) {
    EXPECT_NEAR(v.x, 0.5, 0.03) << "down, a quarter turn about z";
    EXPECT_NEAR(v.y, 0, 0.03);
  }
}

TEST(Taps, ThatWouldLeaveTheSpaceAreRefused) {
  EXPECT_THAT([] { drifting("{keys: [{t: 0}, {t: 2, position: [0.4, 0, 0]}]}"); },
              ThrowsMessage<InputError>(HasSubstr("emitter tap reaches out of space along x at t = 2 s")));
}

/// A jet along a periodic axis of 0.48 m, 0.08 m wide, from a tap that begins at `x`, without
/// gravity.
Scene ring(double x) {
  return parse_scene(
      fmt::format(
          "dreampm: 1\nname: ring\nspace: {{max: [0.48, 0.24, 0.24], spacing: 0.02, periodic: [x]}}\ntime: {{fps: "
          "24}}\n"
          "gravity: [0, 0, 0]\nmaterials: {{water: {{type: newtonian, preset: water, max_compression: 0.03}}}}\n"
          "emitters: {{tap: {{material: water, shape: {{box: {{min: [{}, 0.08, 0.08], max: [{}, 0.16, 0.16]}}}}, "
          "velocity: "
          "[0.5, 0, 0], pool: 50000}}}}\n",
          x, x + 0.08),
      "ring.yaml");
}
/// How many particles of it there are after each of some times [s], and how near any two come.
std::vector<std::size_t> ring_of(double x, const std::vector<double>& times, double& nearest) {
  Simulation s(ring(x), quiet());
  std::vector<std::size_t> counts;
  for (const double t : times) s.advance_to(t), counts.push_back(s.particle_count());
  const ParticleView view = s.particles("water");
  nearest = 1;
  for (std::size_t a = 0; a < view.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      Vec3d way = static_cast<Vec3d>(view.position[a]) - static_cast<Vec3d>(view.position[b]);
      way.x -= 0.48 * std::round(way.x / 0.48);
      nearest = std::min(nearest, length(way));
    }
  return counts;
}

// A tap at the seam gives as much as one in the middle, before the jet comes round and after: it
// meets the matter beyond the end.
TEST(Taps, OnAPeriodicAxisGiveTheSameWhereverTheyStand) {
  const std::vector<double> times{0.4, 1.2, 2};
  double nearest = 0;
  const std::vector<std::size_t> middle = ring_of(0.16, times, nearest);
  EXPECT_GT(nearest, 0.35 * 0.02);
  const double jet = (0.08 + 0.5 * 0.4) * 0.08 * 0.08 / std::pow(0.02, 3);
  EXPECT_NEAR(double(middle[0]), jet, 0.06 * jet);
  for (const double x : {0.0, 0.4}) {  // it begins, or ends, at the seam
    const std::vector<std::size_t> seam = ring_of(x, times, nearest);
    EXPECT_GT(nearest, 0.35 * 0.02) << x;
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_NEAR(double(seam[i]), double(middle[i]), 0.04 * double(middle[i])) << x << ", " << times[i] << " s";
  }
}

// A jet that comes back to its tap fills it: from then on the ring gains nothing. Without that the
// tap puts particles between those that come round, three rings more in 10 s.
TEST(Taps, OnAPeriodicAxisEndWhereTheirJetComesRound) {
  double nearest = 0;
  const std::vector<std::size_t> counts = ring_of(0.16, {1.2, 2, 4}, nearest);
  const double ring = 0.48 * 0.08 * 0.08 / std::pow(0.02, 3);
  EXPECT_NEAR(double(counts[0]), ring, 0.08 * ring);
  EXPECT_NEAR(double(counts[2]), ring, 0.08 * ring);
  EXPECT_LT(double(counts[2]), 1.03 * double(counts[1]));
}

// It looks at nodes and places alone, which a moment keeps.
TEST(Taps, OnAPeriodicAxisHaveTheSameBitsOnAnyThreadsAndAgain) { expect_same_bits(ring(0), 0.9, 1.3); }

// A drain that goes to the matter.
TEST(Drains, ThatMoveTakeWhatTheyMeet) {
  const std::string pool =
      "bodies: {pool: {material: water, shape: {box: {min: [0.4, 0.1, 0.04], max: [0.5, 0.2, 0.16]}}}}\n";
  Simulation s =
      of(tap_room("gravity: [0, 0, 0]\n" + pool +
                  "sinks: {drain: {shape: {box: {min: [0, 0, 0], max: [0.16, 0.4, 0.2]}}, motion: {keys: [{t: 0.1}, "
                  "{t: 0.2, position: [0.38, 0, 0]}]}}}\n"));
  const std::size_t all = s.particle_count();
  s.advance_to(0.1);
  EXPECT_EQ(s.particle_count(), all);
  s.advance_to(0.5);
  EXPECT_EQ(s.particle_count(), 0u);
  EXPECT_EQ(s.totals().drained, all);
  EXPECT_EQ(s.totals().left, 0u) << "by no open wall";
}

}  // namespace
}  // namespace dreampm
