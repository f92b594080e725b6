// What is saved goes on to the bit, and what is opened is what its file says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dreampm/model/scene.h"
#include "play/small_scene.h"

namespace dreampm::play::files_test {
namespace {
using namespace test;
using testing::HasSubstr;

std::filesystem::path fresh_folder(const std::string& name) {
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  return folder;
}

TEST(Playground, WhatItSavesGoesOnToTheBit) {
  const std::filesystem::path folder = fresh_folder("play-save");
  Playground p(small_scene(), quiet_options());
  // Matter of all kinds of state, in the midst of a frame.
  play(p, {"set material.water.viscosity 0.002", "frames 19", "set matter 5", "drop sphere 0.2 0.3 0.12 0.08",
           "set matter 9", "drop box 0.32 0.3 0.12 0.06", "set gravity.x 3", "frames 9", "steps 3",
           "save " + (folder / "tank.yaml").string()});
  Simulation after(load_scene(folder / "tank.yaml"), quiet_options().simulation);
  EXPECT_EQ(after.time(), p.simulation().time());
  EXPECT_EQ(after.hash(), p.hash());
  play(p, {"steps 60"});
  after.advance_steps(60);
  EXPECT_EQ(after.hash(), p.hash());
  EXPECT_EQ(after.totals().kinetic, p.simulation().totals().kinetic);
  EXPECT_THAT(refusal(p, "save pond.txt"), HasSubstr(".yaml"));
  EXPECT_THAT(refusal(p, "save /proc/pond.yaml"), HasSubstr("/proc"));
}

// With what a hand leaves behind: a pin, and a crate that floats.
TEST(Playground, WhatItSavesWithABodyAndAPinGoesOnToTheBit) {
  const std::filesystem::path folder = fresh_folder("play-save-all");
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 2", "drop crate 0.06 0.26 0.12 0.06", "pin 0.28 0.08 0.12 0.04", "frames 20", "steps 2",
           "save " + (folder / "tank.yaml").string()});
  Simulation after(load_scene(folder / "tank.yaml"), quiet_options().simulation);
  EXPECT_EQ(after.hash(), p.hash());
  play(p, {"steps 60"});
  after.advance_steps(60);
  EXPECT_EQ(after.hash(), p.hash());
  EXPECT_EQ(after.collider("crate-1").pose, p.simulation().collider("crate-1").pose);
}

TEST(Playground, WhatItSavesHasBodiesAndPinsWhereTheyAre) {
  const std::filesystem::path folder = fresh_folder("play-save-pond");
  Playground p(load_play_scene("floating-boxes"), quiet_options());
  play(p, {"frames 20", "pin 0.5 0.1 0.3 0.1", "frames 2", "save " + (folder / "pond.yaml").string()});
  const Simulation& before = p.simulation();
  Simulation after(load_scene(folder / "pond.yaml"), quiet_options().simulation);
  for (const model::Collider& c : before.scene().model().colliders) {
    const ColliderState old = before.collider(c.name), now = after.collider(c.name);
    EXPECT_EQ(old.pose, now.pose) << c.name;
    EXPECT_EQ(length(old.twist.velocity - now.twist.velocity), 0) << c.name;
  }
  ASSERT_EQ(after.scene().model().fields.size(), 1U);
  EXPECT_EQ(after.scene().model().fields[0].name, "pin-1");
  EXPECT_EQ(after.hash(), p.hash());
  after.advance_steps(3);
  // Played, its pins can be let go, and others come beside them.
  Playground again(load_play_scene((folder / "pond.yaml").string()), quiet_options());
  EXPECT_EQ(again.simulation().time(), p.simulation().time());
  EXPECT_EQ(again.frame()->marks.size(), 1u);
  play(again, {"pin 0.2 0.1 0.3 0.1", "frames 1"});
  EXPECT_EQ(again.frame()->marks.size(), 2u);
  play(again, {"pin off", "frames 1"});
  EXPECT_TRUE(again.frame()->marks.empty());
  EXPECT_TRUE(again.simulation().scene().model().fields.empty());
}

TEST(Playground, OpensOtherStagesAndRefusesWhatIsNone) {
  Playground p(small_scene(), quiet_options());
  EXPECT_THAT(refusal(p, "open nowhere"), HasSubstr("dam-break"));
  EXPECT_EQ(p.frame()->story, "tank");
  p.act({"open", {"report", "2"}});
  EXPECT_EQ(p.frame()->matter.size(), 2u);
  p.act({"undo", {}});
  EXPECT_EQ(p.frame()->story, "tank") << "another stage is an edit as others are";
  p.act({"redo", {}});
  EXPECT_EQ(p.frame()->matter.size(), 2u);
  EXPECT_THAT(refusal(p, "open report 3"), HasSubstr("no preset 3; the config has 2"));
  EXPECT_THAT(refusal(p, "open report -1"), HasSubstr("whole number"));
  EXPECT_THAT(refusal(p, "fly"), HasSubstr("no verb 'fly'"));
  EXPECT_THAT(refusal(p, "push 1 2"), HasSubstr("word 3 is missing"));
  EXPECT_THAT(refusal(p, "seek soon"), HasSubstr("must be a number"));
  EXPECT_THAT(refusal(p, "drop nothing.obj 0.5 0.5 0.5 0.1"), HasSubstr("nothing.obj"));
  for (const char* line : {"grab 1 2 3 0", "erase 1 2 3 x", "cut 0 0 0 1 0 0 -1", "pin 1 2 3", "drop box 1 2 3"})
    EXPECT_NE(refusal(p, line), "") << line;
  p.act({"undo", {}});
  EXPECT_EQ(p.frame()->story, "tank");
  EXPECT_FALSE(p.frame()->can_undo) << "what was refused is no edit";
}

TEST(Playground, AConfigHasItsPresetsItsTransparencyAndItsWindow) {
  const std::filesystem::path file = fresh_folder("play-config") / "my config.yaml";
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "width: 800\nheight: 600\ngrid number: 32\nmax timestep: 3\nmax hard: 2\nmaterials:\n"
                         "  - {id: 0, name: DIY, default color: [0.2, 0.4, 1, 0.4]}\n"
                         "  - {id: 1, name: CUBE, default color: [1, 0, 0, 1]}\n"
                         "presets:\n"
                         "  - {name: one, material: [0], minimum: [[0.3, 0.3, 0.3]], size: [[0.2, 0.2, 0.2]]}\n"
                         "  - {name: both, material: [1, 0], minimum: [[0.3, 0.6, 0.3], [0.3, 0.3, 0.3]], "
                         "size: [[0.2, 0.2, 0.2], [0.2, 0.2, 0.2]]}\n";
  PlayScene stage = load_play_scene(file.string());
  ASSERT_TRUE(stage.window.has_value());
  EXPECT_EQ(stage.window->width, 800);
  Playground p(std::move(stage), quiet_options());
  EXPECT_EQ(p.frame()->presets, (std::vector<std::string>{"one", "both"}));
  EXPECT_EQ(p.frame()->preset, 0u);
  EXPECT_FLOAT_EQ(p.frame()->matter[0].look->opacity, 0.4f);
  // As the button of the second one does.
  play(p, {Action{"open", {p.frame()->preset_file, "2"}}.text()});
  EXPECT_EQ(p.frame()->preset, 1u);
  EXPECT_EQ(p.frame()->matter.size(), 2u);
  std::filesystem::remove_all(file.parent_path());
}

}  // namespace
}  // namespace dreampm::play::files_test
