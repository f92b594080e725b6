// What a side of a playground remembers: values that are copied, and that begin anew by their list.
#include "dreampm/play/model/play_state.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dreampm/play/model/playground.h"
#include "play/small_scene.h"

namespace dreampm::play::play_state_test {
namespace {
using namespace test;

PlayState used() {
  PlayState state;
  state.settings.paused = true;
  state.clock = {2, 0.01, Jump::back, true, true, 2, 120};
  state.targets["material.water.viscosity"] = 3;
  state.looks["water"].opacity = 0.5f;
  state.losses.all[0] = 7;
  state.compared.main = "water";
  state.message = {"saved", false, 4};
  return state;
}

TEST(PlayState, BeginsAnewWithAnotherSceneButForWhatTheUserSet) {
  PlayState state = used();
  begin_anew<&PlayFieldUse::opens>(state);
  EXPECT_TRUE(state.targets.empty());
  EXPECT_TRUE(state.looks.empty());
  EXPECT_EQ(state.losses.all[0], 0u);
  EXPECT_EQ(state.clock.pending, 0);
  EXPECT_FALSE(state.clock.single_step || state.clock.restart_is_due);
  EXPECT_EQ(state.clock.failures, 0);
  EXPECT_TRUE(state.settings.paused);
  EXPECT_EQ(state.clock.ticks, 120u);
  EXPECT_EQ(state.message.text, "saved");
}

TEST(PlayState, AJumpEndsWhatIsUnderWayAndKeepsTheRest) {
  PlayState state = used();
  begin_anew<&PlayFieldUse::jumps>(state);
  EXPECT_TRUE(state.targets.empty());
  EXPECT_EQ(state.clock.pending, 0.01);
  EXPECT_EQ(state.looks.size(), 1u);
  begin_anew<&PlayFieldUse::ends>(state);
  EXPECT_EQ(state.clock.pending, 0);
  EXPECT_EQ(state.losses.all[0], 7u);
}

// Names of what is dropped count on, and both sides know since when matter is there.
TEST(PlayState, ASecondSideHasAllThatTheFirstRemembers) {
  Playground p(small_scene(), quiet_options());
  play(p, {"set color_by 5", "frames 20", "drop ball 0.2 0.3 0.12 0.06", "pour 0.3 0.3 0.2 0.03 0 -1.5 0", "frames 10",
           "pour off", "frames 20", "compare on", "drop ball 0.1 0.3 0.12 0.06", "frames 1"});
  const std::shared_ptr<const Frame> frame = p.frame();
  const Frame &a = frame->side_a(), &b = frame->side_b();
  ASSERT_EQ(a.bodies.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n) EXPECT_EQ(a.bodies[n].name, b.bodies.at(n).name);
  ASSERT_EQ(a.matter.size(), b.matter.size());
  float youngest = 1;
  for (std::size_t m = 0; m < a.matter.size(); ++m) {
    EXPECT_EQ(a.matter[m].value, b.matter[m].value) << a.matter[m].name;
    for (const float age : a.matter[m].value) youngest = std::min(youngest, age);
  }
  EXPECT_GT(youngest, 0.3f) << "what was poured is as old on both sides";
  EXPECT_LT(youngest, 0.6f);
}

TEST(PlayState, ACopyOfToolsGoesOnByItself) {
  const ToolSet tools;
  const ToolSet copy = tools;
  ASSERT_EQ(tool_buttons().size(), 8u);
  for (const ToolInfo& tool : tool_infos()) {
    ASSERT_NE(copy.find(tool.name), nullptr);
    EXPECT_NE(copy.find(tool.name), tools.find(tool.name)) << tool.name;
  }
  EXPECT_EQ(copy.find("hammer"), nullptr);
}

}  // namespace
}  // namespace dreampm::play::play_state_test
