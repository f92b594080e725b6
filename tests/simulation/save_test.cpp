// A program saves a simulation as a scene that goes on from its moment.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/model/scene.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

class Save : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("save-{}", ::getpid());
    std::filesystem::remove_all(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  /// Saves it, and checks that what is read back has the same bits, then and later.
  void expect_same_future(Simulation& one, const std::string& name = "pond.yaml") {
    one.save(folder / name);
    Simulation two(load_scene(folder / name), quiet(3));
    EXPECT_EQ(two.steps(), one.steps());
    EXPECT_EQ(two.time(), one.time());
    EXPECT_EQ(two.hash(), one.hash());
    one.advance_steps(40), two.advance_steps(40);
    EXPECT_EQ(two.hash(), one.hash());
  }
  std::filesystem::path folder;
};

TEST_F(Save, GoesOnToTheSameBits) {
  Simulation s(dam_and_jelly("asflip"), quiet());
  s.advance_steps(45);
  expect_same_future(s);
}

// Every kind of edit, with a brush that is down: it is a field of the scene then.
TEST_F(Save, GoesOnToTheSameBitsAfterEdits) {
  Simulation s(dam_and_jelly(), quiet());
  script(s, [](int) {});
  s.set_brush("hand", {{0.06, 0.04, 0.08}, 0.05, {1, 2, 0}, 300});
  s.step();
  expect_same_future(s);
}

// A collider whose motion a program took over, one that it moved and stopped, one that it added,
// and a rigid body that floats.
TEST_F(Save, GoesOnToTheSameBitsWithThingsThatMove) {
  Simulation s(
      parse_scene(
          "dreampm: 1\nname: things\nspace: {max: [0.4, 0.3, 0.2], spacing: 0.02}\ntime: {fps: 50, frames: 3}\n"
          "materials: {water: {type: newtonian}}\n"
          "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.2]}}, cut: "
          "[gate, crate]}}\n"
          "colliders:\n"
          "  gate: {shape: {box: {size: [0.04, 0.3, 0.2]}, center: [0.1, 0.1, 0.1]}, motion: {velocity: [0.1, "
          "0, 0]}}\n"
          "  slab: {shape: {box: {min: [0.36, 0.2, 0], max: [0.4, 0.3, 0.2]}}}\n"
          "rigid: {crate: {shape: {box: {size: [0.08, 0.08, 0.08]}}, density: 400, position: [0.25, 0.1, 0.1]}}\n"
          "emitters: {tap: {material: water, shape: {box: {min: [0.3, 0.22, 0.06], max: [0.34, 0.26, 0.14]}}, "
          "velocity: [0, -1, 0], pool: 5000}}\n",
          "things.yaml"),
      quiet());
  s.advance_steps(10);
  s.set_motion("gate", {{0, 0.2, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}});
  s.set_motion("slab", {{-0.5, 0, 0}, {}, {}});
  s.advance_steps(10);
  s.set_motion("slab", {});
  s.add({"plate", Shape::box({0.02, 0.24, 0.02}, {0.06, 0.28, 0.18})});
  s.advance_frames(5);
  ASSERT_GT(s.frame(), 3);
  expect_same_future(s);
  EXPECT_GE(load_scene(folder / "pond.yaml").frames(), 6) << "it is a scene that a run can begin with";
}

TEST_F(Save, MayBeSavedAgainFromWhatWasSaved) {
  Simulation s(dam_and_jelly(), quiet());
  s.advance_steps(20);
  s.save(folder / "one.yaml");
  Simulation two(load_scene(folder / "one.yaml"), quiet());
  two.advance_steps(10);
  expect_same_future(two, "two.yaml");
}

// Eight for one, with the same mass and momentum, in a scene at half the spacing.
TEST_F(Save, AMomentForAFinerScene) {
  Simulation s(dam_and_jelly(), quiet());
  s.advance_steps(30);
  std::filesystem::create_directories(folder);
  model::Scene denser = s.scene().model();
  denser.space.max = denser.space.end(), denser.space.spacing /= 2;
  denser.bodies.clear();
  denser.start = (folder / "finer.h5").string();
  s.save_moment(folder / "finer.h5", Scene(denser, "finer"));
  Simulation finer(Scene(denser, "finer"), quiet());
  EXPECT_EQ(finer.particle_count(), 8 * s.particle_count());
  EXPECT_EQ(finer.time(), s.time());
  const Totals then = s.totals(), now = finer.totals();
  EXPECT_NEAR(now.mass, then.mass, 1e-6 * then.mass);
  EXPECT_LT(length(now.momentum - then.momentum), 1e-4 * length(then.momentum));
  EXPECT_THAT([&] { s.save_moment(folder / "no.h5", s.scene()); },
              ThrowsMessage<InputError>(HasSubstr("with space.spacing 0.01 m, half of what it is")));
  finer.step();
}

// Sinks take some of what two taps gave in turn.
TEST_F(Save, AMomentForAFinerSceneKeepsWhatEmittersGave) {
  const auto tap = [](const char* name, double x, const char* color) {
    return fmt::format(
        "  {}: {{material: water, color: {}, shape: {{box: {{min: [{}, 0.2, 0.06], max: [{}, 0.26, 0.14]}}}}, "
        "velocity: [0, -1, 0], pool: 9000}}\n",
        name, color, x, x + 0.06);
  };
  const Scene scene = parse_scene(
      "dreampm: 1\nname: taps\nspace: {max: [0.4, 0.3, 0.2], spacing: 0.02}\ntime: {fps: 50, frames: 9}\n"
      "materials: {water: {type: newtonian}}\n"
      "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.06, 0.2]}}}}\nemitters:\n" +
          tap("red", 0.08, "[1, 0, 0]") + tap("blue", 0.24, "[0, 0, 1]") +
          "sinks: {drain: {shape: {box: {min: [0.2, 0, 0], max: [0.4, 0.08, 0.2]}}}}\n",
      "taps.yaml");
  Simulation s(scene, quiet());
  s.advance_frames(8);
  std::filesystem::create_directories(folder);
  model::Scene denser = s.scene().model();
  denser.space.max = denser.space.end(), denser.space.spacing /= 2;
  denser.bodies.clear(), denser.sinks.clear();  // it would take some parts of what is at its edge
  denser.start = (folder / "finer.h5").string();
  s.save_moment(folder / "finer.h5", Scene(denser, "finer"));
  Simulation finer(Scene(denser, "finer"), quiet());
  const ParticleView coarse = s.particles("water"), fine = finer.particles("water");
  for (const Vec3f& color : {Vec3f{1, 0, 0}, Vec3f{0, 0, 1}}) {
    const auto counted = [&](const ParticleView& view) { return std::ranges::count(view.color, color); };
    EXPECT_GT(counted(coarse), 50);
    EXPECT_EQ(counted(fine), 8 * counted(coarse));
    const auto middle = [&](const ParticleView& view) {
      Vec3f sum{};
      for (std::size_t p = 0; p < view.size(); ++p)
        if (view.color[p] == color) sum += view.position[p];
      return sum / static_cast<float>(counted(view));
    };
    EXPECT_LT(length(middle(fine) - middle(coarse)), 0.001f);
  }
  finer.advance_frames(1);  // no id comes twice, and taps go on in their colors
  const ParticleView later = finer.particles("water");
  EXPECT_EQ(std::ranges::adjacent_find(later.id), later.id.end());
  EXPECT_GT(std::ranges::count(later.color, Vec3f{1, 0, 0}), std::ranges::count(fine.color, Vec3f{1, 0, 0}));
}

TEST_F(Save, RefusesNamesThatNoSceneHas) {
  Simulation s(dam_and_jelly(), quiet());
  EXPECT_THAT([&] { s.save(folder / "pond.h5"); }, ThrowsMessage<InputError>(HasSubstr("pond.h5 must end in .yaml")));
  EXPECT_THAT([&] { s.save(folder / "my pond.yaml"); },
              ThrowsMessage<InputError>(HasSubstr("the scene's name, 'my pond', must be letters, digits")));
  s.set_brush("my hand", {{0.06, 0.04, 0.08}, 0.05, {1, 2, 0}, 300});
  EXPECT_THAT([&] { s.save(folder / "pond.yaml"); },
              ThrowsMessage<InputError>(HasSubstr("the brush 'my hand' becomes a field of the scene")));
  EXPECT_FALSE(std::filesystem::exists(folder / "pond.yaml"));
  replace_file_text(folder / "file", "");
  EXPECT_THROW(s.save(folder / "file/pond.yaml"), InputError);
}

}  // namespace
}  // namespace dreampm
