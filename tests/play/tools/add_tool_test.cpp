// The tool of docs/howto/add-a-tool.md: the page shows the file that is compiled here.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/base/file.h"
#include "dreampm/play/model/play_model.h"
#include "play/small_scene.h"
#include "play/tools/stop_tool.h"

namespace dreampm::play::add_tool_test {
namespace {
using namespace test;

double kinetic(const PlayModel& model) { return model.simulation->totals().kinetic; }

TEST(AddATool, TheExampleBringsMatterToRestUntilItEnds) {
  PlayModel model(small_scene(), quiet_options());
  for (int n = 0; n < 12; ++n) model.tick({});
  const double before = kinetic(model);
  Stop tool;
  tool.stop(model, Action::parse("stop 0.2 0.1 0.12 0.5"));
  model.tick({});
  EXPECT_LT(kinetic(model), 0.1 * before) << "e^-1.7 of the velocity is left after a tick";
  EXPECT_TRUE(model.history.can_undo());
  tool.end(model);
  EXPECT_FALSE(model.simulation->brush("stop"));
  for (int n = 0; n < 6; ++n) model.tick({});
  EXPECT_GT(kinetic(model), 0.1 * before) << "it falls on";
}

TEST(AddATool, TheExamplesDragPostsItsVerb) {
  Stop tool;
  std::vector<std::string> posted;
  Gesture g;
  g.send = [&](const Action& a) {
    posted.push_back(a.verb);
    return std::uint64_t{0};
  };
  g.hit = Hit{{0.1, 0.1, 0.1}, true};
  tool.press(g);
  g.hit->matter = false;
  tool.drag(g);
  tool.release(g);
  EXPECT_EQ(posted, (std::vector<std::string>{"stop", "release"}));
  EXPECT_EQ(tool.info().verbs.front().name, "stop");
}

TEST(AddATool, ThePageShowsThatFile) {
  const std::filesystem::path root = DM_SOURCE_DIR;
  const std::string page = read_file(root / "docs" / "howto" / "add-a-tool.md");
  EXPECT_NE(page.find("```cpp\n" + read_file(root / "tests" / "play" / "tools" / "stop_tool.h") + "```"),
            std::string::npos);
}

}  // namespace
}  // namespace dreampm::play::add_tool_test
