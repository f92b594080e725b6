// Matter that comes in and goes out: rates, spacing, the ledger, restarts, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;

constexpr double jet_spacing = 0.01, jet_area = 0.04 * 0.04;

std::string jet(const std::string& emitter, const std::string& more = "", const std::string& gravity = "[0, 0, 0]") {
  return "dreampm: 1\nname: jet\nspace: {min: [0, 0, 0], max: [0.6, 0.2, 0.2], spacing: 0.01, walls: {x_max: {type: "
         "open}}}\ntime: {fps: 50}\ngravity: " +
         gravity +
         "\nmaterials: {water: {type: newtonian, preset: water}}\nemitters: {tap: {material: water, shape: {box: {min: "
         "[0.04, 0.08, 0.08], max: [0.08, 0.12, 0.12]}}, " +
         emitter + "}}\n" + more;
}

/// The least distance between two particles.
double nearest(const ParticleView& view) {
  double least = 1e30;
  for (std::size_t a = 0; a < view.size(); ++a)
    for (std::size_t b = a + 1; b < view.size(); ++b)
      least = std::min(least, static_cast<double>(length(view.position[a] - view.position[b])));
  return least;
}

// A jet is one block of water, whatever its speed: as dense as water at rest, and as much a second
// as was asked for.
TEST(Inflow, AJetIsContinuousAtAnySpeed) {
  for (const double speed : {0.05, 1.0, 20.0}) {
    Simulation s(parse_scene(jet("velocity: [" + std::to_string(speed) + ", 0, 0], pool: 100000"), "jet.yaml"),
                 quiet());
    const double time = 0.2 / speed;
    s.advance_to(time);
    const ParticleView view = s.particles("water");
    const double volume = static_cast<double>(view.size()) * jet_spacing * jet_spacing * jet_spacing;
    // What was in the shape at the start, and what came through since.
    EXPECT_NEAR(volume, jet_area * (0.04 + speed * s.time()), 0.01 * jet_area * 0.24 + jet_area * jet_spacing) << speed;
    std::size_t within = 0;
    for (const Vec3f& p : view.position) within += p.x > 0.1033f && p.x < 0.2033f;
    EXPECT_NEAR(static_cast<double>(within) * jet_spacing * jet_spacing * jet_spacing, jet_area * 0.1,
                0.03 * jet_area * 0.1)
        << speed;
    EXPECT_GT(nearest(view), 0.5 * jet_spacing) << speed;
    double slowest = 1e30, fastest = 0;
    for (const Vec3f& v : view.velocity)
      slowest = std::min(slowest, static_cast<double>(v.x)), fastest = std::max(fastest, static_cast<double>(v.x));
    EXPECT_NEAR(slowest, speed, 0.05 * speed);
    EXPECT_NEAR(fastest, speed, 0.05 * speed);
  }
}

TEST(Inflow, AFlowIsCubicMetresASecond) {
  Simulation s(parse_scene(jet("flow: 1.6e-3, direction: [1, 0, 0], pool: 100000"), "jet.yaml"), quiet());
  s.advance_to(0.05);
  const std::size_t before = s.particle_count();
  s.advance_to(0.25);
  const double rate = static_cast<double>(s.particle_count() - before) * 1e-6 / 0.2;
  EXPECT_NEAR(rate, 1.6e-3, 0.01 * 1.6e-3 + 16e-6 / 0.2);
}

TEST(Inflow, StartsStopsAndRunsDry) {
  Simulation s(parse_scene(jet("velocity: [1, 0, 0], start: 0.05, stop: 0.1, pool: 100000"), "jet.yaml"), quiet());
  s.advance_to(0.04);
  EXPECT_EQ(s.particle_count(), 0u);
  s.advance_to(0.2);
  EXPECT_NEAR(static_cast<double>(s.particle_count()) * 1e-6, jet_area * (0.04 + 0.05), jet_area * 1.01 * jet_spacing);
  Simulation dry(parse_scene(jet("velocity: [1, 0, 0], pool: 100"), "jet.yaml"), quiet());
  dry.advance_to(0.1);
  EXPECT_EQ(dry.particle_count(), 100u);
}

// Where matter stands nothing is born: a closed box fills up, and its pressure stays finite.
TEST(Inflow, NothingIsBornWhereMatterStands) {
  std::string text = jet("velocity: [0.5, 0, 0], pool: 100000");
  text.replace(text.find("max: [0.6, 0.2, 0.2]"), 20, "max: [0.2, 0.2, 0.2]");
  text.replace(text.find("{x_max: {type: open}}"), 21, "{}");
  Simulation s(parse_scene(text, "full.yaml"), quiet());
  s.advance_to(12);
  const double volume = static_cast<double>(s.particle_count()) * 1e-6;
  std::printf("%zu particles fill %.4g of the box\n", s.particle_count(), volume / 8e-3);
  EXPECT_GT(volume, 0.9 * 8e-3);
  EXPECT_LT(volume, 1.1 * 8e-3);
  EXPECT_GT(s.totals().volume, 0.95 * volume);
}

/// A tap over a floor with a drain.
std::string tap_and_drain() {
  return "dreampm: 1\nname: tap\nspace: {min: [0, 0, 0], max: [0.4, 0.3, 0.2], spacing: 0.01}\ntime: {fps: 25, frames: "
         "26}\nmaterials: {water: {type: newtonian, preset: water}}\nbodies: {pool: {material: water, shape: {box: "
         "{min: "
         "[0, 0, 0], max: [0.4, 0.04, 0.2]}}}}\nemitters: {tap: {material: water, shape: {box: {min: [0.04, 0.2, "
         "0.08], "
         "max: [0.08, 0.24, 0.12]}}, velocity: [0.5, -0.5, 0], pool: 100000}}\nsinks: {drain: {shape: {box: {min: "
         "[0.3, "
         "0, 0], max: [0.4, 0.02, 0.2]}}}}\noutput: {checkpoint: {every: 5}}\n";
}

TEST(Inflow, TheLedgerClosesWithWhatComesAndGoes) {
  const auto folder = std::filesystem::temp_directory_path() / ("dreampm_inflow_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  const Scene scene = parse_scene(tap_and_drain(), "tap.yaml");
  SimulateOptions options;
  options.folder = folder;
  options.strict = true;
  simulate(scene.description(), {scene.file(), {}}, options);
  const Ledger ledger = read_ledger(folder / "ledger.csv");
  double came = 0, went = 0;
  for (const LedgerRow& row : ledger.rows) came += row.values.at("entered_mass"), went += row.values.at("left_mass");
  std::printf("%.4g kg came, %.4g kg went\n", came, went);
  // Six rows of four columns go through the shape, seen along the diagonal.
  EXPECT_NEAR(came, 998.2 * (0.06 * 0.04 * std::sqrt(0.5) + 0.04 * jet_area), 0.02);
  EXPECT_GT(went, 0.3 * came);
  EXPECT_NEAR(ledger.rows.back().values.at("mass"), ledger.rows.front().values.at("mass") + came - went, 1e-9);
  std::filesystem::remove_all(folder);
}

TEST(Inflow, BitsDoNotDependOnThreadsOrRestarts) {
  const Scene scene = parse_scene(tap_and_drain(), "tap.yaml");
  std::uint64_t end = 0;
  for (const int threads : {1, 3}) {
    Simulation s(scene, quiet(threads));
    s.advance_to(0.15);
    const Snapshot middle = s.snapshot();
    s.advance_to(0.3);
    if (threads == 1) end = s.hash();
    EXPECT_EQ(s.hash(), end);
    s.restore(middle);
    s.advance_to(0.3);
    EXPECT_EQ(s.hash(), end);
    // Edits number their particles after those that came in.
    const std::size_t before = s.particle_count();
    s.add({"drop", "water", SceneShape::sphere({0.2, 0.2, 0.1}, 0.02)});
    const ParticleView view = s.particles("water");
    EXPECT_GT(view.size(), before);
    EXPECT_EQ(std::adjacent_find(view.id.begin(), view.id.end()), view.id.end());
  }
}

TEST(Inflow, EmittersInTheWrongPlaceAreRefused) {
  const auto with = [](const std::string& shape, const std::string& more) {
    return refusal([&] {
      std::string text = jet("velocity: [1, 0, 0], pool: 1000", more);
      const std::string box = "{box: {min: [0.04, 0.08, 0.08], max: [0.08, 0.12, 0.12]}}";
      text.replace(text.find(box), box.size(), shape);
      Simulation(parse_scene(text, "jet.yaml"), quiet());
    });
  };
  EXPECT_THAT(with("{sphere: {radius: 0.05}, center: [0.02, 0.1, 0.1]}", ""),
              HasSubstr("jet.yaml:7:12: error: emitter tap reaches out of space along x"));
  EXPECT_THAT(with("{sphere: {radius: 0.05}, center: [0.2, 0.1, 0.1]}",
                   "colliders: {rock: {shape: {sphere: {radius: 0.05}, center: [0.23, 0.1, 0.1]}}}\n"),
              HasSubstr("emitter tap reaches into collider rock"));
}

}  // namespace
}  // namespace dreampm
