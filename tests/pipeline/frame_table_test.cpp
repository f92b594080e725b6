// Which frames are made, where several tasks noted it.
#include "dreampm/pipeline/frame_table.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include "dreampm/base/file.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;
using testing::ElementsAre;

class FrameTables : public testing::Test {
 protected:
  void SetUp() override { make_folder(folder); }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder = fs::temp_directory_path() / ("dreampm-frame-table-" + std::to_string(::getpid()));
  fs::path base = folder / "frames.csv", one = folder / "one.csv", two = folder / "two.csv";
  const Identity old_settings{{"simulation", "aa"}, {"surface settings", "bb"}};
  const Identity new_settings{{"simulation", "aa"}, {"surface settings", "cc"}};
};

TEST_F(FrameTables, TwoTasksWriteFilesOfTheirOwnAndTheFoldIsBoth) {
  FrameTable(base).enter(1, old_settings);
  const std::string before = read_file(base);
  FrameTable first(base, {}, one), second(base, {}, two);
  first.enter(2, new_settings);
  second.enter(4, new_settings);
  first.enter(3, new_settings);
  EXPECT_EQ(read_file(base), before) << "no task writes it";
  FrameTable all(base, {one, two}, {});
  EXPECT_THAT(all.frames(), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(all.why_redo(3, new_settings), "");
  EXPECT_EQ(all.why_redo(1, new_settings), "the surface settings changed");
  all.fold();
  EXPECT_EQ(read_file(base), "frame,simulation,surface settings\n1,aa,bb\n2,aa,cc\n3,aa,cc\n4,aa,cc\n");
}

TEST_F(FrameTables, WhatATaskTookOutIsOutUntilItIsMade) {
  FrameTable(base).enter(1, old_settings);
  FrameTable task(base, {}, one);
  task.remove(1);
  EXPECT_EQ(FrameTable(base, {one}, {}).why_redo(1, old_settings), "new") << "the task may have been killed there";
  EXPECT_EQ(FrameTable(base, {one}, one).why_redo(1, old_settings), "new") << "nor does it think so itself";
  task.enter(1, new_settings);
  EXPECT_EQ(FrameTable(base, {one}, {}).why_redo(1, new_settings), "");
}

TEST_F(FrameTables, FramesOnWhichTwoTasksDifferAreMadeAgain) {
  FrameTable(base, {}, one).enter(1, old_settings);
  FrameTable(base, {}, two).enter(1, new_settings);
  for (const Identity& settings : {old_settings, new_settings})
    EXPECT_EQ(FrameTable(base, {one, two}, {}).why_redo(1, settings), "new");
}

}  // namespace
}  // namespace dreampm
