// The scenes that are built in to play with.
#include "dreampm/play/model/stories.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/io/png.h"
#include "dreampm/model/scene.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/story_files.h"
#include "dreampm/play/report/report_looks.h"
#include "dreampm/scene.h"
#include "dreampm/simulation.h"

namespace dreampm::play {

/// In messages, and in the names that ctest shows; found beside Story.
static void PrintTo(const Story& story, std::ostream* out) { *out << story.name; }

namespace stories_test {
namespace {

TEST(Stories, AndMatterHaveSmallPictures) {
  std::set<std::string> names{"report-1", "report-2"};
  for (const Story& s : stories()) names.insert(std::string(s.name));
  for (const Matter& m : matters()) names.insert("matter-" + std::string(m.name));
  for (const ReportLook& l : report_looks()) names.insert("look-" + std::string(l.name));
  std::size_t bytes = 0;
  for (const PictureFile& file : picture_files()) {
    EXPECT_EQ(names.erase(std::string(file.name)), 1U) << file.name << " is a picture of nothing";
    const RgbImage picture =
        decode_png({reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()}, std::string(file.name));
    EXPECT_GE(picture.width, 96);
    EXPECT_LE(picture.width, 256);
    bytes += file.bytes.size();
  }
  EXPECT_TRUE(names.empty()) << *names.begin() << " has no picture: tools/play_pictures makes them";
  EXPECT_LT(bytes, 400000U) << "they are in the program and in its history";
}

TEST(Stories, AreTheFilesOfTheirFolder) {
  std::set<std::string> files, list;
  for (const auto& entry : std::filesystem::directory_iterator(DM_SOURCE_DIR "/scenes/play"))
    if (entry.is_regular_file()) files.insert(entry.path().filename().string());
  for (const Story& s : stories()) {
    EXPECT_TRUE(list.insert(std::string(s.name) + ".yaml").second) << s.name << " is there twice";
    EXPECT_EQ(s.scene, read_file(std::string(DM_SOURCE_DIR "/scenes/play/").append(s.name).append(".yaml")));
    EXPECT_FALSE(s.title.empty());
  }
  EXPECT_EQ(list, files);
}

/// Keeps the warnings.
struct Listener final : Host {
  void info(const std::string&) override {}
  void warning(const std::string& line) override { warnings.push_back(line); }
  std::vector<std::string> warnings;
};

class StoryTest : public testing::TestWithParam<Story> {};

TEST_P(StoryTest, StartsMovesAndTakesTwentyStepsWithoutAWarning) {
  const Story& story = GetParam();
  std::vector<std::string> warnings;
  const Scene scene = parse_scene(story.scene, std::string(story.name), {}, &warnings);
  EXPECT_THAT(warnings, testing::IsEmpty());
  EXPECT_EQ(scene.name(), story.name);
  EXPECT_FALSE(scene.model().about.empty());
  EXPECT_EQ(scene.fps(), 60);
  const double seconds = (scene.frames() - 1) / scene.fps();
  EXPECT_GE(seconds, 3.9);
  EXPECT_LE(seconds, 8.1);
  EXPECT_FALSE(scene.model().render.camera.fit_basin) << "a story has a camera of its own";
  Listener listener;
  SimulationOptions options;
  options.host = &listener;
  Simulation simulation(scene, options);
  std::size_t most = simulation.particle_count();
  for (const auto& emitter : scene.model().emitters) most += std::size_t(emitter.pool);
  const bool large_steps = scene.model().time.solver == SolverKind::projection;
  EXPECT_LE(most, large_steps ? 130000u : 32000u) << "too many for real time";
  for (int i = 0; i < 20; ++i) simulation.step();
  EXPECT_GT(simulation.totals().kinetic, 0);
  EXPECT_EQ(simulation.totals().left, 0u);
  EXPECT_THAT(listener.warnings, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Stories, StoryTest, testing::ValuesIn(stories().begin(), stories().end()),
                         [](const auto& one) {
                           std::string name(one.param.name);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace stories_test
}  // namespace dreampm::play
