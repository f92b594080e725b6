// How full the containers of a run are, from its folder.
#include "dreampm/pipeline/fill_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/simulate.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A cup of 0.2 m, whose hollow stands on y = 0.04, with a body in it.
model::Scene cup(const std::string& body, const std::string& colliders = "", int frames = 3) {
  const auto r = scene::parse_scene_text(
      fmt::format(
          "dreampm: 1\nname: cup\nspace: {{min: [0, 0, 0], max: [0.36, 0.36, 0.36], spacing: 0.01}}\n"
          "time: {{fps: 50, frames: {}}}\nmaterials:\n  water: {{type: newtonian}}\n  jelly: {{type: elastic, preset: "
          "jelly}}\n"
          "bodies:\n  it: {}\ncolliders:\n  mold: {{shape: {{container: {{box: {{size: [0.2, 0.2, 0.2]}}, wall: 0.04, "
          "cut: 0}}, center: [0.18, 0.12, 0.18]}}}}\n{}output: {{checkpoint: {{every: 1}}}}\n",
          frames, body, colliders),
      "cup.yaml");
  if (!r.ok()) throw std::runtime_error(r.text());
  return r.scene;
}
std::string water_up_to(double level) {
  return fmt::format("{{material: water, shape: {{box: {{min: [0.08, 0.04, 0.08], max: [0.28, {}, 0.28]}}}}}}", level);
}

class Filled : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(DM_BINARY_DIR) / "test-files" / "fill" / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
  }
  void run(const model::Scene& scene, bool resume = false) const {
    SimulateOptions options;
    options.folder = folder_;
    options.resume = resume;
    simulate(scene, {"cup.yaml", {}}, options);
  }
  FillReport report(std::optional<int> frame = {}) const { return frame_fill(open_run(folder_), frame).reports.at(0); }
  fs::path folder_;
};

TEST_F(Filled, ToTheBrimIsAllAndStaysSo) {
  run(cup(water_up_to(0.24)));
  for (const int frame : {1, 3}) {
    const FillReport r = report(frame);
    EXPECT_EQ(r.collider, "mold");
    EXPECT_NEAR(r.reachable / 0.008, 1, 0.01);
    EXPECT_GE(r.fraction, 0.98) << "frame " << frame;
    EXPECT_DOUBLE_EQ(r.filled, r.fraction * r.reachable);
    EXPECT_EQ(r.leaked, 0);
    EXPECT_TRUE(r.pockets.empty());
  }
}

TEST_F(Filled, HalfIsHalf) {
  run(cup(water_up_to(0.14), "", 1));
  EXPECT_NEAR(report().fraction, 0.5, 0.05);  // a cell is a tenth of the height
}

TEST_F(Filled, OnlyLiquidsFill) {
  run(cup("{material: jelly, shape: {box: {min: [0.08, 0.04, 0.08], max: [0.28, 0.24, 0.28]}}}", "", 1));
  EXPECT_EQ(report().filled, 0);
}

TEST_F(Filled, ABellThatHangsInItIsAPocket) {
  // Its walls are another collider, and its inside is cut out of the water.
  const std::string dry = "{box: {min: [0.14, 0.08, 0.14], max: [0.22, 0.16, 0.22]}}";
  const std::string bell =
      "  bell: {shape: {difference: [{box: {min: [0.12, 0.08, 0.12], max: [0.24, 0.18, 0.24]}}, " + dry + "]}}\n";
  const std::string around = "{box: {min: [0.12, 0.08, 0.12], max: [0.24, 0.18, 0.24]}}";
  run(cup("{material: water, shape: {difference: [{box: {min: [0.08, 0.04, 0.08], max: [0.28, 0.24, 0.28]}}, " +
              around + "]}}",
          bell, 1));
  const FillReport r = report();
  constexpr double inside = 0.08 * 0.08 * 0.08, metal = 0.12 * 0.1 * 0.12 - inside;
  EXPECT_NEAR(r.reachable / (0.008 - metal), 1, 0.02);
  ASSERT_EQ(r.pockets.size(), 1u);
  EXPECT_NEAR(r.pockets[0].volume / inside, 1, 0.2);
  EXPECT_NEAR(length(r.pockets[0].at - Vec3d{0.18, 0.12, 0.18}), 0, 0.01);
}

// A cup that is carried along is measured where it stands, and so is one that is tipped: what it
// can hold then ends at its lowest rim.
TEST_F(Filled, AContainerThatMovesIsMeasuredWhereItIs) {
  model::Scene scene = cup(water_up_to(0.14), "", 6);
  scene.colliders[0].motion.emplace().velocity = {0.3, 0, 0};
  run(scene);
  const Series series = read_series(folder_ / "fill.csv");
  for (const int frame : {1, 6}) {
    const FillReport r = report(frame);
    EXPECT_NEAR(r.fraction, 0.5, 0.08) << "frame " << frame;
    EXPECT_LT(r.leaked, 0.01 * 0.004);
    EXPECT_EQ(series.column("mold.filled_m3")[static_cast<std::size_t>(frame) - 1], r.filled);
  }
  scene = cup(water_up_to(0.06), "", 2);
  scene.colliders[0].motion.emplace().keys = {{0, {}, {0, 0, 1}, 0}, {0.02, {}, {0, 0, 1}, 20}};
  FillMeter meter(scene, regions_of(scene));
  const ParticleFrame none;
  EXPECT_NEAR(meter.measure(none, 0, {})[0].reachable, 0.008, 1e-4);
  // Tipped about z, a wedge under the rim is lost: half of its length squared times the slope.
  EXPECT_NEAR(meter.measure(none, 0.02, {})[0].reachable, 0.008 - 0.5 * 0.2 * 0.2 * 0.2 * std::tan(M_PI / 9), 3e-4);
}

TEST_F(Filled, TheFileHasARowAFrameAlsoAfterAResume) {
  const model::Scene scene = cup(water_up_to(0.2));
  run(scene);
  const std::string whole = read_file(folder_ / "fill.csv");
  const Series series = read_series(folder_ / "fill.csv");
  EXPECT_EQ(series.column("frame"), (std::vector<double>{1, 2, 3}));
  for (std::size_t k = 0; k < 3; ++k) {
    const FillReport r = report(static_cast<int>(k) + 1);
    EXPECT_EQ(series.column("mold.filled_m3")[k], r.filled);
    EXPECT_EQ(series.column("mold.reachable_m3")[k], r.reachable);
    EXPECT_EQ(series.column("mold.pockets")[k], static_cast<double>(r.pockets.size()));
  }
  fs::remove(folder_ / "checkpoint" / numbered("checkpoint", 3, ".h5"));
  run(scene, true);
  EXPECT_EQ(read_file(folder_ / "fill.csv"), whole);
  fs::remove(folder_ / "fill.csv");  // as in a run of an earlier version
  fs::remove(folder_ / "checkpoint" / numbered("checkpoint", 3, ".h5"));
  run(scene, true);
  EXPECT_EQ(read_series(folder_ / "fill.csv").column("frame"), std::vector<double>{3});
}

TEST_F(Filled, SaysWhatThereIsNot) {
  run(cup(water_up_to(0.2), "", 1));
  const auto fill_of_frame = [&](int frame) { return [this, frame] { frame_fill(open_run(folder_), frame); }; };
  EXPECT_THAT(fill_of_frame(7), ThrowsMessage<InputError>(HasSubstr("has no frame 7: it has 1 to 1")));
  model::Scene none = cup(water_up_to(0.2), "", 1);
  none.colliders[0].shape = {};
  none.colliders[0].shape.form = BoxShape{{0.02, 0.02, 0.02}};
  none.colliders[0].shape.center = Vec3d{0.02, 0.3, 0.02};
  run(none);
  EXPECT_FALSE(fs::exists(folder_ / "fill.csv")) << "that of the run before";
  EXPECT_THAT(fill_of_frame(1), ThrowsMessage<InputError>(HasSubstr("no collider of the scene is a container")));
}

HollowLines lines_of(const model::Scene& scene) { return hollow_lines(scene, regions_of(scene)); }

TEST(HollowLines, SayWhatAContainerHolds) {
  const HollowLines lines = lines_of(cup(water_up_to(0.1)));
  ASSERT_EQ(lines.notes.size(), 1u);
  EXPECT_THAT(lines.notes[0], HasSubstr("collider mold: its hollow holds 0.00"));
  EXPECT_THAT(lines.notes[0], HasSubstr("through a mouth of 0.04 m^2"));
  EXPECT_TRUE(lines.warnings.empty());
  const HollowLines narrow = lines_of(
      cup(water_up_to(0.1),
          "  vial: {shape: {container: {box: {size: [0.03, 0.1, 0.1]}, wall: 0.02}, center: [0.18, 0.3, 0.18]}}\n"));
  ASSERT_EQ(narrow.warnings.size(), 1u);
  EXPECT_THAT(narrow.warnings[0], HasSubstr("collider vial: liquid cannot enter its hollow"));
}

}  // namespace
}  // namespace dreampm
