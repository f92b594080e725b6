// What files are opened as.
#include "dreampm/play/model/open_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/solver_choice.h"
#include "play/small_scene.h"

namespace dreampm::play::open_file_test {
namespace {
using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

class OpenFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("open-{}", ::getpid());
    std::filesystem::create_directories(folder);
    write("a.yaml", "dreampm: 1\n");
    write("record.txt", "# dreampm 0.2.0\nplays dam-break\nsteps 3\n");
    write("notes.txt", "plays are nice\n");
    write("it's a tent.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0.3 1 0.3\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  std::filesystem::path folder;
};

TEST_F(OpenFile, EachKindIsOpenedAsSuch) {
  EXPECT_EQ(opening(folder / "a.yaml").verb, "open");
  EXPECT_EQ(opening(folder / "it's a tent.obj").verb, "open");
  EXPECT_EQ(opening(folder / "record.txt").verb, "replay");
  for (const char* name : {"notes.txt", "none.yaml"}) {
    try {
      opening(folder / name);
      ADD_FAILURE() << name;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(name));
    }
  }
  EXPECT_THAT(files_to_open(folder), ElementsAre("a.yaml", "it's a tent.obj", "record.txt"));
}

TEST_F(OpenFile, AMeshFallsAsJelly) {
  const PlayScene stage = load_play_scene((folder / "it's a tent.obj").string());
  EXPECT_EQ(stage.name, "it's a tent");
  Playground p(stage, quiet_options());
  const std::shared_ptr<const Frame> frame = p.frame();
  EXPECT_GT(frame->particles, 500U);
  EXPECT_EQ(matters()[static_cast<std::size_t>(frame->settings.matter)].name, "jelly");
}

TEST_F(OpenFile, ARecordInPlaceOfASceneSaysWhatToDo) {
  try {
    load_play_scene((folder / "record.txt").string());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("--script"));
  }
}

TEST(Matter, TheHandHasThatOfTheStoryAndComparesItWithAnother) {
  for (const auto& [story, name] : {std::pair{"dam-break", "water"},
                                    {"honey-coil", "honey"},
                                    {"jelly-stair", "jelly"},
                                    {"hourglass", "sand"},
                                    {"avalanche", "snow"},
                                    {"toothpaste", "toothpaste"}}) {
    // By the solver that all matter goes with.
    Playground p(by_solver(load_play_scene(story), SolverKind::explicit_steps), quiet_options());
    const std::shared_ptr<const Frame> frame = p.frame();
    EXPECT_EQ(matters()[static_cast<std::size_t>(frame->settings.matter)].name, name) << story;
    ASSERT_GT(frame->settings.compare_with, 0) << story;
    EXPECT_NE(frame->settings.compare_with, frame->settings.matter + 1) << story;
  }
}

}  // namespace
}  // namespace dreampm::play::open_file_test
