// The playground without its window: what hands do, its past, and that it repeats itself.
#include "dreampm/play/model/playground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "dreampm/error.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/random_actions.h"
#include "play/small_scene.h"

namespace dreampm::play::playground_test {
namespace {
using namespace test;
using testing::HasSubstr;

const std::vector<std::string> busy{"frames 4",
                                    "push 0.06 0.05 0.12 0.08 1 0.5 0",
                                    "frames 3",
                                    "release",
                                    "set material.water.viscosity 5",
                                    "frames 4",
                                    "grab 0.28 0.08 0.12 0.05",
                                    "pull 0.3 0.25 0.12",
                                    "frames 6",
                                    "release",
                                    "set matter 1",
                                    "pour 0.2 0.3 0.12 0.03 0 -1.5 0",
                                    "frames 6",
                                    "pour off",
                                    "set matter 5",
                                    "drop sphere 0.1 0.3 0.12 0.08",
                                    "frames 5",
                                    "cut 0.28 0.08 0.12 0 1 0 0.4",
                                    "frames 3",
                                    "pin 0.28 0.06 0.12 0.05",
                                    "frames 2",
                                    "erase 0.05 0.02 0.1 0.04",
                                    "frames 2",
                                    "undo",
                                    "frames 2",
                                    "pin off",
                                    "shake 10 0 0",
                                    "frames 3",
                                    "set gravity.x 3",
                                    "frames 4"};

TEST(Playground, RepeatsItselfForAnyNumberOfThreads) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2}) {
    Playground p(small_scene(), quiet_options(threads));
    play(p, busy);
    if (threads == 1) one = p.hash();
    EXPECT_EQ(p.hash(), one);
    EXPECT_TRUE(finite(*p.frame()));
  }
}

TEST(Playground, StepsThatWereCountedGiveTheSameAgain) {
  Playground a(small_scene(), quiet_options()), b(small_scene(), quiet_options());
  const int first = a.tick({}), second = a.tick({std::nullopt, 1e-4});
  EXPECT_GT(first, 0);
  EXPECT_GT(second, 0);
  EXPECT_LE(second, first + 1);
  b.tick({first, {}}), b.tick({second, {}});
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Playground, AFrameIsASixtiethOfASecondOrSlower) {
  Playground p(small_scene(), quiet_options());
  for (int n = 0; n < 30; ++n) p.tick({});
  EXPECT_NEAR(p.simulation().time(), 0.5, 0.004);
  play(p, {"set speed 0.25", "frames 30"});
  EXPECT_NEAR(p.simulation().time(), 0.625, 0.004);
  play(p, {"set paused 1", "frames 5"});
  const double paused = p.simulation().time();
  play(p, {"step", "frames 1"});
  EXPECT_GT(p.simulation().time(), paused);
  const std::uint64_t steps = p.simulation().steps();
  play(p, {"frames 3"});
  EXPECT_EQ(p.simulation().steps(), steps);
}

TEST(Playground, EveryControlTakesItsWholeRangeAndSaysWhatItHas) {
  Playground p(small_scene(), quiet_options());
  const auto controls = p.frame()->controls;
  std::set<std::string> ids;
  for (const ControlInfo& c : *controls) {
    EXPECT_TRUE(ids.insert(c.id).second) << c.id << " is there twice";
    EXPECT_GE(c.fallback, c.min) << c.id;
    EXPECT_LE(c.fallback, c.max) << c.id;
    EXPECT_TRUE(c.min > 0 || !c.decades) << c.id;
    const double before = value_of(p, c.id);
    std::map<std::string, double> others;
    for (const ControlInfo& o : *controls)
      if (o.id != c.id) others[o.id] = value_of(p, o.id);
    for (const double value : {c.min, c.max}) {
      p.act({"set", {c.id, text_of(value)}});
      EXPECT_NEAR(value_of(p, c.id), value, 1e-6 * std::abs(value)) << c.id;
    }
    for (const auto& [id, other] : others) EXPECT_EQ(value_of(p, id), other) << c.id << " changed " << id;
    p.act({"set", {c.id, text_of(before)}});
    EXPECT_THAT(refusal(p, "set " + c.id + " 1e30"), HasSubstr("must be between"));
  }
  EXPECT_TRUE(ids.contains("material.water.viscosity"));
  EXPECT_THAT(refusal(p, "set honey 1"), HasSubstr("no control 'honey'"));
}

TEST(Playground, AMaterialComesToWhatWasAskedForByAndBy) {
  Playground p(small_scene(), quiet_options());
  play(p, {"set material.jelly.youngs_modulus 1000000", "frames 1"});
  const auto now = [&] {
    for (const std::string& line : {p.simulation().scene().yaml()}) {
      const std::size_t at = line.find("youngs_modulus: ");
      return std::stod(line.substr(at + 16));
    }
    return 0.0;
  };
  EXPECT_LT(now(), 2e4) << "in one tick";
  play(p, {"frames 20"});
  EXPECT_EQ(now(), 1e6);
  EXPECT_TRUE(finite(*p.frame()));
}

TEST(Playground, UndoAndRedoGoToTheVeryBits) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 5"});
  expect_exact_undo_of_erasing(p);
  play(p, {"undo", "frames 3", "set material.water.viscosity 3", "frames 20", "undo"});
  EXPECT_NEAR(value_of(p, "material.water.viscosity"), 1e-3, 1e-5);
  EXPECT_THAT(refusal(p, "redo"), "") << "one edit is ahead";
  Playground fresh(small_scene(), quiet_options());
  EXPECT_THAT(refusal(fresh, "undo"), HasSubstr("nothing to undo"));
}

TEST(Playground, ATiltOfTheBoxIsOneEdit) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 5"});
  for (int n = 1; n <= 4; ++n)
    play(p, {"set gravity.x " + text_of(n), "set gravity.z 1", "set gravity.y -9", "frames 1"});
  play(p, {"undo"});
  EXPECT_EQ(value_of(p, "gravity.x"), 0);
  EXPECT_EQ(value_of(p, "gravity.y"), -9.81);
  EXPECT_THAT(refusal(p, "undo"), HasSubstr("nothing to undo"));
}

TEST(Playground, GoesBackInTime) {
  Playground p(small_scene(), quiet_options());
  std::vector<double> times;
  for (int n = 0; n < 120; ++n) p.tick({}), times.push_back(p.simulation().time());
  const double now = p.simulation().time();
  EXPECT_GT(p.frame()->past, 1.5);
  p.act({"seek", {"1"}});
  EXPECT_NEAR(p.simulation().time(), now - 1, 0.12);
  EXPECT_NEAR(p.frame()->future, 1, 0.12);
  const std::uint64_t then = p.hash();
  play(p, {"frames 3", "seek 0.5", "seek 9"});
  EXPECT_LT(p.simulation().time(), now - 1);
  // From there on another future: the old one is forgotten.
  play(p, {"frames 20"});
  EXPECT_LT(p.frame()->future, 1e-9);
  EXPECT_NE(p.hash(), then);
}

TEST(Playground, AHandOfThePastLetsGo) {
  Playground p(small_scene(), quiet_options());
  play(p, {"set gravity.y 0", "frames 5", "push 0.28 0.08 0.12 0.08 2 0 0", "frames 12", "pin 0.06 0.05 0.12 0.05",
           "frames 12", "pin off", "release", "frames 30"});
  // Back to where the hand pushed and the pin held.
  play(p, {"seek 0.6", "frames 1"});
  const auto brushes = [&] { return p.simulation().names().brushes.size(); };
  EXPECT_EQ(brushes(), 1u) << "the pin is there again, the hand is not";
  play(p, {"pin off", "frames 1"});
  EXPECT_EQ(brushes(), 0u);
}

TEST(Playground, AGrabCarriesMatterToTheHand) {
  Playground p(small_scene(), quiet_options());
  play(p, {"set gravity.y 0", "frames 2", "grab 0.28 0.08 0.12 0.06", "pull 0.28 0.25 0.12", "frames 40"});
  double y = 0;
  const auto frame = p.frame();
  for (const Vec3f& x : frame->matter[1].position) y += static_cast<double>(x.y);
  y /= static_cast<double>(frame->matter[1].position.size());
  EXPECT_NEAR(y, 0.25, 0.04);
}

TEST(Playground, APinHoldsWhatWouldFall) {
  Playground free(small_scene(), quiet_options()), held(small_scene(), quiet_options());
  play(free, {"frames 15"});
  play(held, {"pin 0.28 0.08 0.12 0.1", "frames 15"});
  const auto lowest = [](Playground& p) {
    float y = 1;
    const auto frame = p.frame();
    for (const Vec3f& x : frame->matter[1].position) y = std::min(y, x.y);
    return y;
  };
  EXPECT_LT(lowest(free), 0.02f);
  EXPECT_GT(lowest(held), 0.03f);
}

TEST(Playground, AReportMaterialBeginsAnewOrForgetsItsDeformation) {
  Playground p(load_play_scene("report", 0), quiet_options());
  EXPECT_EQ(value_of(p, "material.diy.v"), 0.5);
  play(p, {"frames 60"});
  EXPECT_NEAR(p.simulation().time(), 60 * 25 * 2e-4, 1e-3);
  play(p, {"set material.diy.v 0.1", "frames 1"});
  EXPECT_LT(p.simulation().time(), 0.02) << "Auto Restart is on";
  play(p, {"frames 60", "set auto_restart 0", "set material.diy.v 0.7", "frames 20"});
  EXPECT_GT(p.simulation().time(), 0.3) << "it is off";
  EXPECT_EQ(value_of(p, "material.diy.v"), 0.7);
  play(p, {"set time_step 0", "frames 5"});
  const double stands = p.simulation().time();
  play(p, {"frames 5"});
  EXPECT_EQ(p.simulation().time(), stands) << "0 pauses";
}

TEST(Playground, EachEditThatIsDoneIsTakenBackByItself) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 2", "set gravity.y -5", "set gravity.y -4", "done", "frames 2", "set gravity.y -3",
           "set gravity.y -2", "done", "frames 2", "undo"});
  EXPECT_EQ(value_of(p, "gravity.y"), -4);
  play(p, {"undo"});
  EXPECT_EQ(value_of(p, "gravity.y"), -9.81);
  EXPECT_FALSE(p.frame()->can_undo);
}

/// Pages of this process in memory.
double resident_pages() {
  std::ifstream in("/proc/self/statm");
  double all = 0, resident = 0;
  in >> all >> resident;
  return resident;
}

TEST(Playground, MemoryStaysFlat) {
  Playground p(small_scene(), quiet_options());
  double early = 0;
  for (int n = 1; n <= 120; ++n) {
    play(p, {"set matter " + std::to_string(n % 3), "pour 0.2 0.3 0.12 0.04 0 -1.5 0", "frames 4", "pour off",
             "erase 0.2 0.1 0.12 0.1", "frames 3"});
    p.frame();
    if (n == 55) early = resident_pages();  // the past and the undone edits are full
  }
  ASSERT_GT(early, 0);
  EXPECT_LT(resident_pages(), 1.1 * early);
}

/// Whatever is typed and dragged, nothing breaks, and nothing is lost but what is taken out.
TEST(Playground, SurvivesRandomHands) {
  for (const std::uint64_t seed : {1, 2}) {
    Playground p(small_scene(), quiet_options(2));
    RandomActions hands(seed);
    for (int turn = 0; turn < 60; ++turn) {
      try {
        p.act(hands.next(*p.frame()));
      } catch (const InputError&) {
        // Refused, as a hand sees it.
      }
      for (int tick = 0; tick < 2; ++tick) p.tick({20, {}});
      ASSERT_TRUE(finite(*p.frame())) << seed << ' ' << turn;
    }
    const Totals t = p.simulation().totals();
    EXPECT_TRUE(std::isfinite(t.kinetic));
    EXPECT_EQ(t.left, 0u);
  }
}

TEST(Playground, SlowMotionMovesWhereAStepIsLongerThanATick) {
  for (const Playground::Limit& limit : {Playground::Limit{}, Playground::Limit{std::nullopt, 0.1}}) {
    Playground p(small_scene(), quiet_options());
    play(p, {"set speed 0.015625"});
    ASSERT_LT(1 / 64.0 / 60, 0.5 * p.simulation().dt()) << "what a tick asks for is too little for a step";
    for (int n = 0; n < 256; ++n) p.tick(limit);
    EXPECT_NEAR(p.simulation().time(), 256 / 64.0 / 60, p.simulation().dt());
  }
}

TEST(Playground, RewindAfterUndoLeadsToWhatIsNow) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 30"});
  const std::size_t all = p.simulation().particle_count();
  play(p, {"erase 0.05 0.05 0.1 0.08", "frames 60"});
  EXPECT_LT(p.simulation().particle_count(), all);
  play(p, {"undo", "frames 12", "seek 0.1"});
  EXPECT_EQ(p.simulation().particle_count(), all);
  play(p, {"frames 60", "seek 0.5"});
  EXPECT_EQ(p.simulation().particle_count(), all) << "what was undone stays undone";
}

TEST(Playground, WhatDoesNotGoWithASceneIsSaidAndTheWorldGoesOn) {
  // A collider of the name of a matter that is poured.
  PlayScene stage = small_scene();
  stage.scene = parse_scene(stage.scene.yaml() +
                                "colliders:\n  stone: {shape: {box: {min: [0.34, 0, 0], max: "
                                "[0.4, 0.05, 0.05]}}}\n",
                            "tank.yaml");
  Playground p(std::move(stage), quiet_options());
  const std::size_t all = p.simulation().particle_count();
  std::size_t stone = 0;
  while (matters()[stone].name != "stone") ++stone;
  play(p, {"frames 12", "set matter " + std::to_string(stone), "pour 0.2 0.3 0.12 0.03 0 -1.5 0", "frames 12"});
  EXPECT_THAT(p.frame()->message, HasSubstr("stone"));
  EXPECT_EQ(p.simulation().particle_count(), all);
  // Colors of matter that is not there.
  std::size_t by_j = 0;
  while (color_choices()[by_j] != "J") ++by_j;
  play(p, {"erase 0.2 0.2 0.12 1", "set color_by " + std::to_string(by_j), "frames 2"});
  EXPECT_EQ(p.simulation().particle_count(), 0u);
  EXPECT_EQ(p.frame()->value_label, "J");
}

TEST(Playground, SingleEditsAreUndoneOneByOne) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 6", "restart", "frames 12"});
  const std::uint64_t before = p.hash();
  play(p, {"restart", "frames 2", "undo"});
  EXPECT_EQ(p.hash(), before);
  play(p, {"pin 0.28 0.08 0.12 0.05", "pin 0.06 0.05 0.12 0.05"});
  EXPECT_EQ(p.frame()->marks.size(), 2u);
  play(p, {"undo"});
  ASSERT_EQ(p.frame()->marks.size(), 1u);
  EXPECT_FLOAT_EQ(p.frame()->marks[0].at.x, 0.28f);
  play(p, {"pin off"});
  EXPECT_TRUE(p.frame()->marks.empty());
  EXPECT_THAT(refusal(p, "pin off"), HasSubstr("nothing is held"));
  play(p, {"undo"});
  EXPECT_EQ(p.frame()->marks.size(), 1u);
}

TEST(Playground, LooksStayWithTheirMatter) {
  Playground p(small_scene(), quiet_options());
  const auto look = [&](const std::string& name) {
    for (const MatterFrame& m : p.frame()->matter)
      if (m.name == name) return *m.look;
    throw std::out_of_range(name);
  };
  const auto drop = [&](const std::string& name) {
    std::size_t kind = 0;
    while (matters()[kind].name != name) ++kind;
    play(p, {"set matter " + std::to_string(kind), "drop sphere 0.2 0.3 0.12 0.08", "frames 6"});
  };
  drop("snow");
  const MatterLook snow = look("snow");
  play(p, {"frames 6", "restart"});
  drop("sand");
  EXPECT_FALSE(look("sand") == snow);
  play(p, {"undo", "undo"});
  EXPECT_TRUE(look("snow") == snow);
}

TEST(Playground, BallsAreOfTheReportAlone) {
  Playground report(load_play_scene("report"), quiet_options()), tank(small_scene(), quiet_options());
  for (const MatterFrame& m : report.frame()->matter) {
    EXPECT_NEAR(static_cast<double>(m.look->ball) * report.frame()->spacing, 0.01, 1e-6) << "m";
    EXPECT_FALSE(m.look->grains);
  }
  for (const MatterFrame& m : tank.frame()->matter) EXPECT_EQ(m.look->ball, 0) << m.name;
}

TEST(Action, WordsMayBeQuotedAndHaveAnEnd) {
  const Action a = Action::parse("drop \"a \\\"cup\\\".obj\" 0.1 0.2 # over the water");
  EXPECT_EQ(a.verb, "drop");
  EXPECT_EQ(a.words, (std::vector<std::string>{"a \"cup\".obj", "0.1", "0.2"}));
  EXPECT_EQ(Action::parse(a.text()).words, a.words);
  EXPECT_TRUE(Action::parse("  # nothing else").verb.empty());
  EXPECT_THROW(Action::parse("drop \"a cup 0.1 0.2"), InputError);
}

}  // namespace
}  // namespace dreampm::play::playground_test
