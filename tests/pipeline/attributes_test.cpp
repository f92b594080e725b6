// What vertices of a run's surfaces hold, and what its particles are asked for that.
#include <gmock/gmock.h>

#include <set>

#include "dreampm/base/file.h"
#include "dreampm/base/host.h"
#include "dreampm/error.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"
#include "thrown.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

/// A pool, and two taps of one paint above it, blue and yellow, that run into one another.
const std::string paints_text = R"(dreampm: 1
name: taps
space: {min: [0, 0, 0], max: [0.6, 0.5, 0.3], spacing: 0.025}
time: {fps: 25, frames: 9}
materials: {paint: {type: newtonian, viscosity: 2, max_compression: 0.1}}
bodies: {pool: {material: paint, color: [0, 0.13, 0.52], shape: {box: {min: [0, 0, 0], max: [0.6, 0.05, 0.3]}}}}
emitters:
  late: {material: paint, color: [1, 0.2, 0.1], pool: 4000, start: 0.1, velocity: [0, -1, 0],
         shape: {box: {size: [0.1, 0.05, 0.1]}, center: [0.15, 0.4, 0.15]}}
  tap: {material: paint, color: [0.99, 0.83, 0], pool: 4000, velocity: [0, -1, 0],
        shape: {box: {size: [0.1, 0.05, 0.1]}, center: [0.45, 0.4, 0.15]}}
output: {checkpoint: {every: 3}}
surface: {attributes: [color, source, age, j, vorticity]}
render: {looks: {paint: {type: opaque}}}
)";

model::Scene parsed(const std::string& text) {
  const auto result = scene::parse_scene_text(text, "scene.yaml", {});
  EXPECT_TRUE(result.ok()) << result.text();
  return result.scene;
}

class Attributes : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(DM_BINARY_DIR) / "test-files" / "attributes" /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
  }
  void run(const model::Scene& scene, const char* name, std::optional<int> frames = {}, bool resume = false) const {
    SilentHost silent;
    const HostScope scope(&silent);
    SimulateOptions options;
    options.folder = folder_ / name;
    options.frames = frames, options.resume = resume;
    simulate(scene, {"scene.yaml", std::nullopt}, options);
  }
  ParticleFrame particles(const char* name, int frame) const {
    return read_particles(folder_ / name / "particles" / numbered("particles", frame, ".ply"));
  }
  fs::path folder_;
};

TEST_F(Attributes, OfParticlesSayWhereTheyCameFromAndWhen) {
  run(parsed(paints_text), "run");
  const ParticleFrame last = particles("run", 9);
  EXPECT_EQ(last.source_names, (std::vector<std::string>{"late", "tap", "pool"}));
  const std::vector<float>&source = last.columns.at("source"), &age = last.columns.at("age");
  EXPECT_EQ(last.columns.count("j"), 1u) << "surfaces ask for it";
  const float now = 8 / 25.0f;
  std::set<float> sources;
  for (std::size_t i = 0; i < last.size(); ++i) {
    sources.insert(source[i]);
    const bool left = last.position[i].x < 0.3f;
    EXPECT_TRUE(last.position[i].y <= 0.15f || source[i] == (left ? 0 : 1));
    EXPECT_TRUE(source[i] != 2 || std::abs(age[i] - now) < 1e-6f);
    EXPECT_TRUE(source[i] != 0 || age[i] <= now - 0.1f + 1e-5f);
    // It falls at 1 m/s and faster: who is in the tap is young.
    EXPECT_TRUE(last.position[i].y <= 0.38f || age[i] < 0.06f);
  }
  EXPECT_EQ(sources, (std::set<float>{0, 1, 2}));
  // A particle is as much older in the next frame.
  const ParticleFrame before = particles("run", 8);
  for (std::size_t i = 0; i < before.size(); ++i) {
    ASSERT_EQ(before.id[i], last.id[i]);
    EXPECT_EQ(before.columns.at("source")[i], source[i]);
    EXPECT_NEAR(before.columns.at("age")[i] + 1 / 25.0f, age[i], 1e-5f);
  }
}

TEST_F(Attributes, AreTheSameInARunThatGoesOn) {
  const model::Scene scene = parsed(paints_text);
  run(scene, "whole");
  run(scene, "halves", 5);
  run(scene, "halves", {}, true);
  for (const int frame : {3, 5, 9})
    EXPECT_EQ(read_file(folder_ / "whole/particles" / numbered("particles", frame, ".ply")),
              read_file(folder_ / "halves/particles" / numbered("particles", frame, ".ply")))
        << frame;
}

TEST_F(Attributes, OfVerticesAreThoseOfTheParticlesThere) {
  run(parsed(paints_text), "run");
  SilentHost silent;
  const HostScope scope(&silent);
  RunFolder run = open_run(folder_ / "run", Access::write);
  surface_stage(run, {9, 9});
  VertexAttributes all;
  const TriMesh mesh = read_mesh(surface_file(run, 0, 9), &all);
  EXPECT_TRUE(mesh.velocities.empty()) << "not asked for";
  ASSERT_EQ(all.size(), 5u);
  const auto values = [&](const char* name) -> const std::vector<float>& { return find_attribute(all, name)->values; };
  const auto color = [&](std::size_t v) {
    const std::vector<float>& c = values("color");
    return Vec3f{c[3 * v], c[3 * v + 1], c[3 * v + 2]};
  };
  int yellow = 0, green = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3f& x = mesh.vertices[v];
    EXPECT_EQ(values("source")[v], std::round(values("source")[v]));
    EXPECT_GT(values("j")[v], 0.8f);
    EXPECT_LT(values("j")[v], 1.2f);
    EXPECT_GE(values("age")[v], 0);
    if (x.y > 0.25f && x.x > 0.3f) {
      EXPECT_EQ(values("source")[v], 1);
      EXPECT_NEAR(color(v).x, 0.979f, 0.02f);
      EXPECT_NEAR(color(v).z, 0, 0.02f);
      ++yellow;
    }
    // Where yellow lies on blue.
    const Vec3f c = color(v);
    green += c.y > 1.15f * c.x && c.y > 1.15f * c.z;
  }
  EXPECT_GT(yellow, 20);
  EXPECT_GT(green, 20) << "blue and yellow paint give green";
}

TEST_F(Attributes, AnOldRunThatLacksOneSaysSo) {
  run(parsed(paints_text), "run", 1);
  // As a version without these columns wrote it.
  const fs::path file = folder_ / "run/particles/particles_000001.ply";
  ParticleFrame frame = read_particles(file);
  frame.columns.erase("age");
  write_particles(file, frame);
  SilentHost silent;
  const HostScope scope(&silent);
  RunFolder run = open_run(folder_ / "run", Access::write);
  EXPECT_THAT(
      test::message_of<InputError>([&] { surface_stage(run, {1, 1}); }),
      HasSubstr("particles_000001.ply: has no column age, of which surface.attributes makes age: simulate again"));
  EXPECT_FALSE(fs::exists(surface_file(run, 0, 1)));
}

TEST_F(Attributes, ASceneWithoutThemWritesNoneOfThem) {
  std::string text = paints_text;
  text.replace(text.find("surface: {attributes: [color, source, age, j, vorticity]}"), 57, "");
  while (text.find(", color: [") != std::string::npos) {
    const std::size_t at = text.find(", color: [");
    text.erase(at, text.find(']', at) + 1 - at);
  }
  run(parsed(text), "run", 2);
  EXPECT_TRUE(particles("run", 2).columns.empty());
  EXPECT_TRUE(particles("run", 2).source_names.empty());
}

TEST(AttributesOfScenes, AWrongNameSaysWhichThereAre) {
  std::string text = paints_text;
  text.replace(text.find("vorticity]"), 10, "vorticty]");
  const auto result = scene::parse_scene_text(text, "scene.yaml", {});
  EXPECT_FALSE(result.ok());
  EXPECT_THAT(result.text(), HasSubstr("scene.yaml:13:47: error"));
  EXPECT_THAT(result.text(), HasSubstr("vorticity"));
}

}  // namespace
}  // namespace dreampm
