// Scenes whose liquids move by a projection: what they may hold, taps and drains, snapshots, edits.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/start.h"
#include "dreampm/simulation/simulation_impl.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::string basin(const std::string& more, const std::string& material = "type: newtonian, preset: water",
                  const std::string& space = "", const std::string& time = "") {
  return "dreampm: 1\nname: basin\nspace: {max: [0.4, 0.4, 0.2], spacing: 0.02, walls: {ceiling: {type: open}}" +
         space + "}\ntime: {fps: 24, frames: 60, solver: projection" + time + "}\nmaterials: {water: {" + material +
         "}}\n" + more;
}
const std::string dam =
    "bodies: {dam: {material: water, shape: {box: {min: [0, 0, 0], max: [0.12, 0.24, 0.2]}}, "
    "sample: {pattern: jitter}}}\n";
Simulation liquid_of(const std::string& text) { return Simulation(parse_scene(text, "basin.yaml"), quiet()); }

TEST(ProjectionScenes, RefuseByNameWhatTheSolverCannotDo) {
  const auto refused = [](const std::string& text, const std::string& what) {
    EXPECT_THAT([&] { liquid_of(text); }, ThrowsMessage<InputError>(AllOf(HasSubstr("basin.yaml"), HasSubstr(what))))
        << what;
  };
  refused(basin(dam, "type: elastic, density: 1000, youngs_modulus: 1.0e4, poissons_ratio: 0.3"), "there is no liquid");
  refused(basin(dam, "type: newtonian, preset: water, tension: true"), "tension");
  refused(basin(dam, "type: newtonian, preset: water, transfer: flip"), "the transfer apic alone");
  refused(basin(dam, "type: newtonian, preset: water", ", periodic: [x]"),
          "space.periodic has x, along which there are 12 cells");
  refused(basin(dam, "type: newtonian, preset: water", "", ", cfl: 4"), "time.cfl");
  EXPECT_THAT(
      [&] {
        parse_scene(
            "dreampm: 1\nname: b\nspace: {max: [1, 1, 1], spacing: 0.1}\ntime: {cfl: 2}\nmaterials: "
            "{water: {type: newtonian, preset: water}}\n" +
                dam,
            "b.yaml");
      },
      ThrowsMessage<InputError>(HasSubstr("time.cfl")));
}

TEST(ProjectionScenes, StepsForPreviewsAreWarnedOf) {
  const auto warnings = [](const std::string& time) {
    ListeningHost host;
    SimulationOptions options = quiet();
    options.host = &host;
    const Simulation s(parse_scene(basin(dam, "type: newtonian, preset: water", "", time), "basin.yaml"), options);
    return host.warnings;
  };
  EXPECT_THAT(warnings(", cfl: 2.5"), testing::Contains(AllOf(HasSubstr("time.cfl is 2.5"), HasSubstr("previews"))));
  EXPECT_THAT(warnings(", cfl: 2"), testing::IsEmpty());
}

const std::string tap_over_dam =
    dam +
    "emitters: {tap: {material: water, shape: {box: {min: [0.26, 0.3, 0.06], max: [0.34, 0.34, 0.14]}}, velocity: "
    "[0, -0.5, 0], pool: 50000}}\nsinks: {drain: {shape: {box: {min: [0.3, -0.1, 0], max: [0.4, 0.03, 0.2]}}}}\n";

// Outflow through the drain, and gravity that turns meanwhile, are part of the state.
TEST(ProjectionScenes, ATapAndADrainHaveTheSameBitsOnAnyThreadsAndAgain) {
  std::set<std::uint64_t> ends;
  expect_same_bits(
      parse_scene(basin(tap_over_dam), "basin.yaml"), 0.3, 0.6, [](Simulation&) {},
      [&](Simulation& s) {
        EXPECT_GT(s.totals().drained, 20u);
        s.set_gravity({1, -9.81, 0});
        s.advance_to(0.7);
        ends.insert(s.hash());
      });
  EXPECT_EQ(ends.size(), 1u);
}

TEST(ProjectionScenes, ATapAndADrainLoseNothing) {
  Simulation s = liquid_of(basin(tap_over_dam));
  const std::size_t first = s.particle_count();
  s.advance_to(1.5);
  const Totals t = s.totals();
  EXPECT_GT(t.drained, 200u);
  EXPECT_EQ(t.left, 0u);
  EXPECT_GT(t.particles + t.drained, first + 200);
  EXPECT_LT(s.steps(), 400u);
  double fastest = 0;
  for (const Vec3f& v : s.particles("water").velocity) fastest = std::max(fastest, static_cast<double>(length(v)));
  EXPECT_LT(fastest, 4);
}

TEST(ProjectionScenes, ATapAloneBeginsWithNoMatter) {
  Simulation s =
      liquid_of(basin("emitters: {tap: {material: water, shape: {box: {min: [0.16, 0.2, 0.06], max: [0.24, 0.24, "
                      "0.14]}}, velocity: [0, "
                      "-1, 0], start: 0.1, pool: 5000}}\n"));
  s.advance_to(0.09);
  EXPECT_EQ(s.particle_count(), 0u);
  s.advance_to(0.5);
  EXPECT_GT(s.particle_count(), 200u);
}

// Cells are 0.04 m.
TEST(ProjectionScenes, ACupOfACellHoldsAndAThinnerOneIsWarnedOf) {
  const auto cup = [](double t) {
    return fmt::format(
        "bodies: {{fill: {{material: water, shape: {{box: {{min: [0.12, 0.08, 0.04], max: [0.28, 0.2, 0.16]}}}}, "
        "sample: "
        "{{pattern: jitter}}}}}}\ncolliders: {{cup: {{shape: {{difference: [{{box: {{min: [{}, {}, 0], max: [{}, 0.3, "
        "0.2]}}}}, {{box: {{min: [0.12, 0.08, 0.04], max: [0.28, 0.31, 0.16]}}}}]}}}}}}\n",
        0.12 - t, 0.08 - t, 0.28 + t);
  };
  Simulation s = liquid_of(basin(cup(0.04)));
  s.advance_to(1);
  const ParticleView view = s.particles("water");
  const auto out = std::count_if(view.position.begin(), view.position.end(),
                                 [](const Vec3f& p) { return p.x < 0.11f || p.x > 0.29f || p.y < 0.07f; });
  EXPECT_LE(out, static_cast<std::ptrdiff_t>(view.position.size() / 50));
  ListeningHost host;
  SimulationOptions options = quiet();
  options.host = &host;
  const Simulation thin(parse_scene(basin(cup(0.03)), "cup.yaml"), options);
  EXPECT_THAT(host.warnings, testing::Contains(HasSubstr("less than a cell")));
}

// A piston as wide as the basin: the level rises by what it takes the place of.
TEST(ProjectionScenes, APistonPushesWaterUp) {
  Simulation s = liquid_of(basin(
      "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.16, 0.2]}}, sample: {pattern: "
      "jitter}}}\ncolliders: {piston: {shape: {box: {min: [-0.2, -0.1, -0.1], max: [0, 0.5, 0.3]}}, motion: {velocity: "
      "[0.1, 0, 0]}}}\n"));
  s.advance_to(1);
  const ParticleView view = s.particles("water");
  double sum = 0;
  std::size_t behind = 0;
  for (const Vec3f& p : view.position) sum += static_cast<double>(p.y), behind += p.x < 0.098f;
  EXPECT_EQ(behind, 0u);
  // 0.16 m deep over 0.4 m, then over 0.3 m.
  EXPECT_NEAR(sum / static_cast<double>(view.position.size()), 0.5 * 0.16 * 0.4 / 0.3, 0.006);
}

TEST(ProjectionScenes, ASnapshotGoesOnToTheSameBits) {
  Simulation s =
      liquid_of(basin(dam + "colliders: {post: {shape: {sphere: {radius: 0.06}, center: [0.25, 0.04, 0.1]}}}\n"));
  s.advance_frames(6);
  const Snapshot then = s.snapshot();
  s.advance_frames(6);
  const std::uint64_t hash = s.hash();
  s.restore(then);
  s.advance_frames(6);
  EXPECT_EQ(s.hash(), hash);
}

/// Returns a cork as dense as water.
model::Collider cork(const Shape& shape) {
  model::Collider body{"cork", shape};
  body.friction = 0.4, body.rigid = {.density = 1000};
  return body;
}

TEST(ProjectionScenes, GravityAndMatterMayBeEditedAndWhatTheSolverCannotDoNot) {
  Simulation s = liquid_of(basin(dam));
  s.advance_frames(3);
  s.set_gravity({3, -9, 0});
  s.add({"drop", "water", Shape::sphere({0.3, 0.3, 0.1}, 0.04), {0, -1, 0}, {}});
  const std::size_t count = s.particle_count();
  s.advance_frames(5);
  EXPECT_EQ(s.particle_count(), count);
  const std::uint64_t before = s.hash();
  const auto refused = [&](const auto& edit, const std::string& what) {
    EXPECT_THAT(edit, ThrowsMessage<InputError>(HasSubstr(what)));
  };
  refused([&] { s.set_parameter("water", "tension", 1); }, "tension");
  refused([&] { s.add_material({"oil", "newtonian", {{"density", 900}, {"viscosity", 0.001002}}}); },
          "differ in density");
  EXPECT_EQ(s.hash(), before) << "what was refused has changed something";
  s.set_parameter("water", "viscosity", 20);
  s.add(cork(Shape::sphere({0.3, 0.3, 0.1}, 0.04)));
  s.set_wall(Side::x_min, {WallType::stick});
  s.add_material({"drift", "snow", preset("snow", "powdery")});
  s.add({"lump", "drift", Shape::sphere({0.1, 0.3, 0.1}, 0.03), {}, {}});
  s.advance_frames(1);
}

TEST(ProjectionScenes, EveryEditGivesTheSameBitsOnAnyThreadsAndFromASnapshot) {
  std::uint64_t once = 0;
  for (const int threads : {1, 3}) {
    Simulation s(
        parse_scene(basin(dam + "colliders: {post: {shape: {sphere: {radius: 0.04}, center: [0.3, 0.1, 0.1]}}}\n"),
                    "basin.yaml"),
        quiet(threads));
    Snapshot middle;
    const auto script = [&](int from) {
      for (int step = from; step <= 34; ++step) {
        s.step();
        if (step == 3) s.set_parameter("water", "viscosity", 2);
        if (step == 5) s.set_gravity({3, -9, 1});
        if (step == 7) s.set_wall(Side::z_max, {WallType::slip});
        if (step == 9) s.add({"drop", "water", Shape::sphere({0.3, 0.3, 0.1}, 0.04), {0, -1, 0}, {}});
        if (step == 11) s.set_brush("hand", {{0.06, 0.04, 0.08}, 0.05, {1, 2, 0}, 300});
        if (step == 13) s.add(cork(Shape::sphere({0.1, 0.34, 0.1}, 0.04)));
        if (step == 15) middle = s.snapshot();
        if (step == 17) s.remove_brush("hand"), s.reset_state("water");
        if (step == 19) s.set_motion("post", {{0.1, 0, 0}, {0, 2, 0}, {0.3, 0.1, 0.1}});
        if (step == 21) s.add_particles("water", std::vector<Vec3d>{{0.02, 0.38, 0.08}, {0.06, 0.38, 0.1}}, {0, -2, 0});
        if (step == 23) s.remove(Shape::box({0, 0, 0}, {0.06, 0.2, 0.1}));
        if (step == 25) s.add({"shelf", Shape::box({0.3, 0.34, 0.1}, {0.36, 0.4, 0.16})});
        if (step == 27) s.attach("cork", {{0.1, 0.34, 0.1}, {0.2, 0.3, 0.1}, 40, 2});
        if (step == 29) s.set_parameter("water", "density", 900), s.remove_collider("shelf");
        if (step == 31) s.detach("cork"), s.remove_collider("cork");
      }
      return s.hash();
    };
    const std::uint64_t hash = script(1);
    if (threads == 1) once = hash;
    EXPECT_EQ(hash, once);
    s.restore(middle);
    EXPECT_EQ(script(16), once);
    for (const Vec3f& x : s.particles("water").position) ASSERT_TRUE(std::isfinite(x.x + x.y + x.z));
  }
}

/// kg m/s, of all water, over its mass.
Vec3d mean_velocity(const Simulation& s) {
  const Totals t = s.totals();
  return t.momentum * (1 / t.mass);
}

// In the air nothing else holds it: what a brush gives is its exact solution.
TEST(ProjectionScenes, ABrushTakesWaterAlongAndADragStopsIt) {
  const std::string drop =
      "bodies: {drop: {material: water, shape: {sphere: {radius: 0.05}, center: [0.2, 0.2, 0.1]}, sample: {pattern: "
      "jitter}}}\ngravity: [0, 0, 0]\n";
  Simulation pushed = liquid_of(basin(drop));
  pushed.set_brush("hand", {{0.2, 0.2, 0.1}, 10, {0.3, 0.1, 0}, 40});
  pushed.advance_frames(4);
  EXPECT_NEAR(mean_velocity(pushed).x, 0.3, 0.005);
  EXPECT_NEAR(mean_velocity(pushed).y, 0.1, 0.005);
  pushed.remove_brush("hand");
  pushed.advance_frames(2);
  EXPECT_NEAR(mean_velocity(pushed).x, 0.3, 0.005);
  Simulation held = liquid_of(basin(drop + "fields: {air: {type: drag, rate: 5, velocity: [0.4, 0, 0]}}\n"));
  held.advance_to(0.2);
  EXPECT_NEAR(mean_velocity(held).x, 0.4 * (1 - std::exp(-5 * 0.2)), 0.01);
}

// Both act at places alone: what is beside them is left alone.
TEST(ProjectionScenes, AFastBrushActsWhereItIsAndShortensTheStep) {
  Simulation s = liquid_of(
      basin("bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.16, 0.2]}}, sample: {pattern: "
            "jitter}}}\n"));
  s.advance_frames(4);
  const double calm = s.dt();
  s.set_brush("hand", {{0.1, 0.1, 0.1}, 0.06, {0, 12, 0}, 200});
  EXPECT_LE(s.dt() * 12, 4 * 0.04 * 1.0001);
  EXPECT_LT(s.dt(), 0.7 * calm);
  s.advance_frames(2);
  double near = 0, far = 0;
  const ParticleView view = s.particles("water");
  for (std::size_t i = 0; i < view.position.size(); ++i)
    (view.position[i].x < 0.2f ? near : far) =
        std::max(static_cast<double>(view.velocity[i].y), view.position[i].x < 0.2f ? near : far);
  EXPECT_GT(near, 1);
  EXPECT_LT(far, 0.5 * near);
}

TEST(ProjectionScenes, StepsAreAsLongAsTheyAreAskedForLive) {
  Simulation s = liquid_of(basin(dam));
  s.advance_frames(6);
  const double usual = s.dt();
  s.set_cfl(0.5);
  EXPECT_LT(s.dt(), 0.5 * usual);
  EXPECT_EQ(s.cfl(), 0.5);
  EXPECT_THROW(s.set_cfl(4), InputError);
  s.advance_frames(1);
}

// A piston that leaves water less room than it takes: no pressure can do it, and nothing is lost.
TEST(ProjectionScenes, AClosedBoxThatIsTooFullKeepsItsMatter) {
  Simulation s(parse_scene("dreampm: 1\nname: press\nspace: {max: [0.4, 0.2, 0.2], spacing: 0.02}\ntime: {fps: 24, "
                           "frames: 60, solver: projection}\nmaterials: {water: {type: newtonian, preset: "
                           "water}}\nbodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.16, "
                           "0.2]}}, sample: {pattern: jitter}}}\ncolliders: {piston: {shape: {box: {min: [-0.2, -0.1, "
                           "-0.1], max: [0, 0.5, 0.3]}}, motion: {velocity: [0.2, 0, 0]}}}\n",
                           "press.yaml"),
               quiet());
  const std::size_t count = s.particle_count();
  s.advance_to(1.2);
  EXPECT_EQ(s.particle_count(), count);
  for (const Vec3f& x : s.particles("water").position)
    ASSERT_TRUE(x.x >= 0 && x.x <= 0.4f && x.y >= 0 && x.y <= 0.2f) << x.x << " " << x.y;
}

// Hydrostatic: what lies deep is pressed by what is above.
TEST(ProjectionScenes, ParticlesHaveThePressureOfTheirCells) {
  Simulation s = liquid_of(
      basin("bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.2, 0.2]}}, sample: {pattern: "
            "jitter}}}\n"));
  s.advance_frames(24);
  const ParticleView water = s.particles("water");
  const AttributeView pressure = s.attribute("water", "pressure");
  double worst = 0;
  for (std::size_t i = 0; i < water.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(pressure.values[i]) -
                                     1000 * 9.81 * (0.2 - static_cast<double>(water.position[i].y))));
  // Half a cell is as exact as the cell's own value may be.
  EXPECT_LT(worst, 1000 * 9.81 * 0.75 * 0.04);
}

TEST(ProjectionScenes, AMomentThatIsSavedGoesOnToTheSameBits) {
  Simulation s = liquid_of(basin(dam));
  s.advance_frames(5);
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / fmt::format("dreampm-moment-{}.h5", ::getpid());
  s.save_moment(file);
  Simulation on = liquid_of(basin("start: " + file.string() + "\n"));
  EXPECT_EQ(on.frame(), s.frame());
  s.advance_frames(5), on.advance_frames(5);
  EXPECT_EQ(on.hash(), s.hash());
  const std::string other =
      "dreampm: 1\nname: b\nspace: {max: [0.4, 0.4, 0.2], spacing: 0.02, walls: {ceiling: {type: "
      "open}}}\ntime: {fps: 24, frames: 60}\nmaterials: {water: {type: newtonian, preset: "
      "water}}\nstart: " +
      file.string() + "\n";
  EXPECT_THAT([&] { liquid_of(other); }, ThrowsMessage<InputError>(HasSubstr("was made by time.solver: projection")));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace dreampm
