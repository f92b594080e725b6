// Foam of a run: files, what a second call does, frames made singly, what is refused.
#include "dreampm/pipeline/foam_stage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dreampm/base/file.h"
#include "dreampm/base/host.h"
#include "dreampm/base/parallel.h"
#include "dreampm/pipeline/export_stage.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"
#include "thrown.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

class FoamStage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(DM_BINARY_DIR) / "test-files" / "foam" / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    const auto parsed = scene::parse_scene_text(R"(dreampm: 1
name: dam
space: {min: [0, 0, 0], max: [0.8, 0.6, 0.24], spacing: 0.03}
time: {fps: 24, frames: 16, solver: projection}
materials: {water: {type: newtonian}}
bodies: {column: {material: water, shape: {box: {min: [0, 0, 0], max: [0.3, 0.45, 0.24]}}}}
foam: {amount: 0.02}
)",
                                                "scene.yaml", {});
    ASSERT_TRUE(parsed.ok()) << parsed.text();
    const HostScope scope(&silent_);
    SimulateOptions options;
    options.folder = folder_;
    simulate(parsed.scene, {"scene.yaml", std::nullopt}, options);
  }
  StageResult make(const FrameRange& frames = {}) {
    const HostScope scope(&silent_);
    RunFolder run = open_run(folder_, Access::write);
    return foam_stage(run, frames);
  }
  std::string bytes(int frame) const { return read_file(foam_file(open_run(folder_), frame)); }
  fs::path folder_;
  SilentHost silent_;
};

TEST_F(FoamStage, MakesEveryFrameOnceAndRecordsWhatItEmitted) {
  EXPECT_EQ(make().made, 16);
  EXPECT_EQ(make().made, 0);
  const RunFolder run = open_run(folder_);
  EXPECT_EQ(no_foam(run, run.frames()), "");
  const FoamFrame last = read_foam(foam_file(run, 16));
  ASSERT_GT(last.particles.size(), 100u);
  std::uint64_t emitted = 0;
  for (const FoamRecord& f : run.record.stages.at("foam").foam) emitted += f.emitted();
  EXPECT_EQ(emitted, last.particles.next_id);
  const Box3d box{run.scene.space.min, run.scene.space.end()};
  for (const Vec3f& p : last.particles.position) EXPECT_TRUE(box.contains(static_cast<Vec3d>(p)));
  EXPECT_THAT(foam_lines(run.record).at(0), HasSubstr("% crest"));
  EXPECT_GT(run.record.stages.at("foam").found.at("speed.to"), 0.5);
}

TEST_F(FoamStage, FramesMadeSinglyAndByOtherThreadsAreTheSameBytes) {
  make();
  const std::string all = bytes(16), middle = bytes(9);
  const RunFolder run = open_run(folder_);
  fs::remove(foam_file(run, 9));
  EXPECT_EQ(make({9, 9}).made, 1);
  EXPECT_EQ(bytes(9), middle);
  EXPECT_EQ(make().made, 0);  // those after it were made of the same
  fs::remove_all(folder_ / "foam");
  {
    const ThreadLimit one(1);
    EXPECT_EQ(make({1, 10}).made, 10);
    EXPECT_EQ(make().made, 6);
  }
  EXPECT_EQ(bytes(16), all);
}

TEST_F(FoamStage, AFrameAsksForTheOneBefore) {
  const std::string refused = test::refusal([&] { make({5, 6}); });
  EXPECT_THAT(refused, HasSubstr("frame 5 is made of the foam of frame 4"));
  EXPECT_THAT(refused, HasSubstr("dreampm foam"));
}

TEST_F(FoamStage, OtherSettingsMakeItAgainWithoutASimulation) {
  make();
  const std::string before = bytes(12);
  const fs::path file = folder_ / "scene.yaml";
  std::string text = read_file(file);
  const std::size_t at = text.find("amount: 0.02");
  ASSERT_NE(at, std::string::npos);
  replace_file_text(file, text.replace(at, 12, "amount: 0.1"));
  EXPECT_THAT(no_foam(open_run(folder_), {12}), HasSubstr("not up to date: the foam settings changed"));
  const StageResult again = make();
  EXPECT_EQ(again.made, 16);
  EXPECT_EQ(again.why, "the foam settings changed");
  EXPECT_GT(bytes(12).size(), 2 * before.size());
}

TEST_F(FoamStage, IsInEveryExport) {
  const auto exported = [&](const char* format, const std::string& file) {
    const HostScope scope(&silent_);
    ExportOptions options;
    options.format = format, options.first = options.last = 16, options.what_there_is = true;
    options.axes.scale = 100;
    export_run(open_run(folder_), options);
    return read_file(folder_ / "export" / file);
  };
  EXPECT_THAT(exported("usd", "dam.usda"), testing::Not(HasSubstr("\"foam\"")));  // there is none yet
  make();
  const FoamParticles foam = read_foam(foam_file(open_run(folder_), 16)).particles;
  exported("ply", "ply/foam_000016.ply");
  const ParticleFrame ply = read_particles(folder_ / "export" / "ply" / "foam_000016.ply");
  ASSERT_EQ(ply.size(), foam.size());
  EXPECT_NEAR(ply.position[5].y, 100 * foam.position[5].y, 1e-3);  // in centimeters
  EXPECT_NEAR(ply.columns.at("radius")[5], 100 * foam.radius[5], 1e-5);
  EXPECT_EQ(ply.columns.at("type")[5], static_cast<float>(foam.type[5]));
  const std::string usd = exported("usd", "dam.usda");
  EXPECT_THAT(usd, HasSubstr("def Points \"foam\""));
  EXPECT_THAT(usd, HasSubstr("float[] widths.timeSamples"));
  EXPECT_THAT(usd, HasSubstr("primvars:life"));
  EXPECT_GT(exported("vtkhdf", "dam-foam.vtkhdf").size(), 10 * foam.size());
  EXPECT_THAT(exported("vdb", "vdb/dam_000016.vdb"), HasSubstr("foam"));
  EXPECT_THAT(exported("gltf", "gltf/dam_000016.glb"), HasSubstr("_RADIUS"));
  EXPECT_THAT(exported("obj", "obj/foam_000016.obj"), HasSubstr(fmt::format("p {}", foam.size())));
}

TEST_F(FoamStage, RefusesParticlesWithoutVelocities) {
  const fs::path file = open_run(folder_).particles(4);
  const std::string whole = read_file(file);
  std::string text = "ply\nformat ascii 1.0\ncomment material 0 water\nelement vertex 1\n";
  for (const char* p : {"x", "y", "z"}) text += fmt::format("property float {}\n", p);
  replace_file_text(file, text + "property int id\nproperty uchar material\nend_header\n0.1 0.1 0.1 0 0\n");
  EXPECT_THAT(test::refusal([&] { make(); }), HasSubstr("particles_000004.ply: has no velocities"));
  replace_file_text(file, whole);
  EXPECT_EQ(make().made, 16);
}

TEST_F(FoamStage, NamesWhatIsWrongWithAFileOfFoam) {
  make();
  const RunFolder run = open_run(folder_);
  const fs::path file = foam_file(run, 12);
  const std::string whole = read_file(file);
  replace_file_text(file, whole.substr(0, whole.size() - 5));
  EXPECT_THAT(test::refusal([&] { read_foam(file); }), HasSubstr("foam_000012.ply"));
  EXPECT_THAT(test::refusal([&] { read_foam(run.particles(3)); }), HasSubstr("not a file of dreampm foam"));
}

TEST(FoamKey, SaysWhereItIsWrong) {
  const auto problems = [](const std::string& foam) {
    return scene::parse_scene_text(R"(dreampm: 1
name: a
space: {max: [1, 1, 1], spacing: 0.1}
materials: {water: {type: newtonian}, jelly: {type: elastic}}
bodies:
  a: {material: water, shape: {box: {min: [0, 0, 0], max: [0.4, 0.4, 0.4]}}}
  b: {material: jelly, shape: {box: {min: [0.5, 0, 0], max: [0.9, 0.4, 0.4]}}}
)" + foam + "\n",
                                   "s.yaml", {})
        .text();
  };
  EXPECT_EQ(problems("foam: {}"), "");
  EXPECT_THAT(problems("foam: {amount: -1}"), HasSubstr("s.yaml:8:16: error: foam.amount is -1: must be"));
  EXPECT_THAT(problems("foam: {of: [jelly]}"), HasSubstr("s.yaml:8:13: error: foam.of: 'jelly' is elastic, a solid"));
  EXPECT_THAT(problems("foam: {of: [watr]}"), HasSubstr("did you mean 'water'?"));
  EXPECT_THAT(problems("foam: {life: [5, 2]}"), HasSubstr("must not be below foam.life[0], 5"));
  EXPECT_THAT(problems("foam: {crest: {from: 3, to: 2}}"), HasSubstr("foam.crest.to is 2: must be above"));
  EXPECT_THAT(problems("foam: {amont: 2}"), HasSubstr("did you mean 'amount'?"));
}

TEST(FoamKey, NeedsMatterThatFoams) {
  const auto parsed = scene::parse_scene_text(R"(dreampm: 1
name: a
space: {max: [1, 1, 1], spacing: 0.1}
materials: {jelly: {type: elastic}}
bodies: {b: {material: jelly, shape: {box: {min: [0, 0, 0], max: [0.4, 0.4, 0.4]}}}}
foam: {}
)",
                                              "s.yaml", {});
  EXPECT_THAT(parsed.text(), HasSubstr("s.yaml:6:7: error: foam: no material foams"));
}

}  // namespace
}  // namespace dreampm
