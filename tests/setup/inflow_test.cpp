// Matter that comes in and goes out: rates, spacing, the ledger, restarts, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dreampm/io/ledger.h"
#include "dreampm/io/series.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "dreampm/solver/emission_pattern.h"
#include "simulation/scenes.h"

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
    // The volume in the shape at the start, and that which came through since.
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

TEST(Inflow, AFlowIsCubicMetersASecond) {
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

// No matter is born where matter stands: a closed box fills up, and its pressure stays finite.
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
  simulate(scene.model(), {scene.file(), {}}, options);
  const Ledger ledger = read_ledger(folder / "ledger.csv");
  double came = 0, went = 0;
  for (const LedgerRow& row : ledger.rows) came += row.entered_mass, went += row.left_mass;
  std::printf("%.4g kg came, %.4g kg went\n", came, went);
  // The shape itself, and what comes through its section, as seen along the diagonal, in a second.
  const double volume = 0.04 * std::sqrt(2.0) * 0.04 * std::sqrt(0.5) + 0.04 * jet_area;
  EXPECT_NEAR(came, 998.2 * volume, 0.015 * 998.2 * volume);
  EXPECT_GT(went, 0.3 * came);
  EXPECT_NEAR(ledger.rows.back().mass, ledger.rows.front().mass + came - went, 1e-9);
  std::filesystem::remove_all(folder);
}

TEST(Inflow, BitsDoNotDependOnThreadsOrRestarts) {
  const Scene scene = parse_scene(tap_and_drain(), "tap.yaml");
  expect_same_bits(
      scene, 0.15, 0.3, [](Simulation&) {},
      [](Simulation& s) {
        // Edits number their particles after those that came in.
        const std::size_t before = s.particle_count();
        s.add({"drop", "water", Shape::sphere({0.2, 0.2, 0.1}, 0.02)});
        const ParticleView view = s.particles("water");
        EXPECT_GT(view.size(), before);
        EXPECT_EQ(std::adjacent_find(view.id.begin(), view.id.end()), view.id.end());
      });
}

TEST(Inflow, FlowFollowsItsKeys) {
  // Nothing, then up to 1.6 l/s and down again: 0.16 l in all. It falls along x, out of the way of
  // what comes after: an emitter does not push.
  Simulation s(parse_scene(jet("flow: {keys: [{t: 0.05, value: 0}, {t: 0.15, value: 1.6e-3}, {t: 0.25, value: 0}]}, "
                               "direction: [1, 0, 0], pool: 100000",
                               "", "[20, 0, 0]"),
                           "jet.yaml"),
               quiet());
  s.advance_to(0.04);
  const auto filled = static_cast<double>(s.particle_count());  // the shape itself
  EXPECT_NEAR(filled * 1e-6, jet_area * 0.04, jet_area * jet_spacing);
  s.advance_to(0.15);
  EXPECT_NEAR((static_cast<double>(s.particle_count()) - filled) * 1e-6, 0.8e-4, 0.01 * 0.8e-4 + 16e-6);
  s.advance_to(0.3);
  EXPECT_NEAR((static_cast<double>(s.particle_count()) - filled) * 1e-6, 1.6e-4, 0.01 * 1.6e-4 + 16e-6);
}

TEST(Inflow, SwirlTurnsTheJetAboutItsWay) {
  Simulation s(parse_scene(jet("velocity: [1, 0, 0], swirl: 10, pool: 100000"), "jet.yaml"), quiet());
  s.advance_to(0.03);
  const ParticleView view = s.particles("water");
  double moment = 0, inertia = 0;
  for (std::size_t p = 0; p < view.size(); ++p) {
    if (view.position[p].x > 0.08f) continue;
    const double y = view.position[p].y - 0.1, z = view.position[p].z - 0.1;
    moment += y * static_cast<double>(view.velocity[p].z) - z * static_cast<double>(view.velocity[p].y);
    inertia += y * y + z * z;
  }
  std::printf("the jet turns at %.3f rad/s\n", moment / inertia);
  EXPECT_NEAR(moment / inertia, 10, 0.5);
}

TEST(Inflow, JitterKeepsHalfASpacing) {
  Simulation s(parse_scene(jet("velocity: [1, 0, 0], jitter: 0.25, pool: 100000"), "jet.yaml"), quiet());
  s.advance_to(0.06);
  EXPECT_GE(nearest(s.particles("water")), 0.499 * jet_spacing);
}

/// The places that a round jet of that radius has brought when it has come that far [spacings], in
/// moves of that length, as they lie in the jet.
std::vector<Vec3d> places_of_jet(double radius, double far, double move, const Vec3d& along, std::uint64_t seed) {
  Shape disc;
  disc.form = CylinderShape{radius, 2};
  const Vec3d axis = cross(Vec3d{0, 1, 0}, along);
  disc.rotate_axis = length(axis) > 0 ? axis : Vec3d{1, 0, 0};
  disc.rotate_angle = std::acos(along.y) * 180 / M_PI;
  const std::shared_ptr<const Region> region = make_region(disc, 1, {});
  const EmissionPattern pattern(*region, along, 1, seed);
  EXPECT_NEAR(pattern.area(), M_PI * radius * radius, 0.02 * M_PI * radius * radius);
  std::vector<Vec3d> places;
  double moved = 0;
  while (moved < far - 1e-9) {
    const double before = moved;
    moved = std::min(moved + move, far);
    pattern.for_entering(before, moved, false, [&](const Vec3d& p) { places.push_back(p - along * moved); });
  }
  return places;
}

// The inflow is as large as the section and the way ask for, wherever the jet points; no two places
// are near one another, and none follows another in a column.
TEST(Inflow, PlacesOfAJetAreNewAllAlongIt) {
  constexpr double radius = 3, far = 250;
  for (const Vec3d& along : {Vec3d{0, -1, 0}, Vec3d{1, 0, 0}, normalized(Vec3d{1, 2, -3})}) {
    const std::vector<Vec3d> places = places_of_jet(radius, far, 0.25, along, 1);
    const double wanted = M_PI * radius * radius * far;
    EXPECT_NEAR(static_cast<double>(places.size()), wanted, 0.006 * wanted);
    double least = 1e30;
    std::size_t pairs = 0, columns = 0;
    for (std::size_t a = 0; a < places.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const Vec3d off = places[a] - places[b];
        least = std::min(least, length(off));
        const double ahead = std::abs(dot(off, along));
        const double aside = std::sqrt(std::max(length2(off) - ahead * ahead, 0.0));
        // A lattice has one on its column in each of these layers.
        if (ahead > 0.5 && ahead < 20.5) ++pairs, columns += aside < 0.1;
      }
    EXPECT_GT(least, 0.85);
    // By chance the share of a column's section in the jet's, and a little more for its rim.
    EXPECT_LT(static_cast<double>(columns), 1.3 * 0.1 * 0.1 / (radius * radius) * static_cast<double>(pairs));
  }
}

TEST(Inflow, PlacesOfAJetDependOnItsSeedAndNotOnTheLengthOfSteps) {
  const auto sorted = [](std::vector<Vec3d> places) {
    std::sort(places.begin(), places.end(),
              [](const Vec3d& a, const Vec3d& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
    return places;
  };
  const Vec3d down{0, -1, 0};
  const std::vector<Vec3d> fine = sorted(places_of_jet(3, 20, 0.03, down, 1)),
                           coarse = sorted(places_of_jet(3, 20, 1.7, down, 1)),
                           other = sorted(places_of_jet(3, 20, 1.7, down, 2));
  ASSERT_EQ(fine.size(), coarse.size());
  for (std::size_t i = 0; i < fine.size(); ++i) EXPECT_NEAR(length(fine[i] - coarse[i]), 0, 1e-9);
  std::size_t same = 0;
  for (std::size_t i = 0; i < std::min(fine.size(), other.size()); ++i) same += length(fine[i] - other[i]) < 0.1;
  EXPECT_LT(same, fine.size() / 20);
}

TEST(Inflow, SaysOnceThatItsPoolIsUsedUp) {
  ListeningHost host;
  SimulationOptions options;
  options.threads = 1, options.host = &host;
  Simulation s(parse_scene(jet("velocity: [1, 0, 0], pool: 100"), "jet.yaml"), options);
  s.advance_to(0.1);
  const auto said = std::count_if(host.warnings.begin(), host.warnings.end(), [](const std::string& line) {
    return line.find("emitter tap: its pool of 100 particles is used up at t = ") != std::string::npos;
  });
  EXPECT_EQ(said, 1);
}

// A collider may take out what touches it; a probe counts it, and another what came in.
TEST(Inflow, AColliderTakesOutWhatTouchesIt) {
  const auto folder = std::filesystem::temp_directory_path() / ("dreampm_touch_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  const Scene scene = parse_scene(
      jet("velocity: [1, 0, 0], stop: 0.1, pool: 100000",
          "colliders: {fire: {shape: {sphere: {radius: 0.04}, center: [0.3, 0.1, 0.1]}, on_touch: delete}}\nprobes: "
          "{came: {type: inflow, on: tap}, burnt: {type: inflow, on: fire}, there: {type: pose, on: fire}}\n"),
      "fire.yaml");
  SimulateOptions options;
  options.folder = folder;
  options.frames = 26;
  options.strict = true;
  simulate(scene.model(), {scene.file(), {}}, options);
  const Series came = read_series(folder / "probes" / "came.csv"), burnt = read_series(folder / "probes" / "burnt.csv"),
               there = read_series(folder / "probes" / "there.csv");
  const double in = came.rows.back().at(3), out = burnt.rows.back().at(3);
  std::printf("%g particles came, %g touched the sphere\n", in, out);
  EXPECT_NEAR(came.rows.back().at(2), in * 1e-6, 1e-12);
  EXPECT_GT(out, 0.9 * in);
  EXPECT_LE(out, in);
  EXPECT_EQ(there.rows.back().at(4), 1);  // it does not turn
  const Ledger ledger = read_ledger(folder / "ledger.csv");
  EXPECT_NEAR(ledger.rows.back().particles, in - out, 0.5);
  std::filesystem::remove_all(folder);
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
