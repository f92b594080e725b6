// Scenes that a pressure projection moves, in the playground: tools, past, sliders, and what it
// cannot do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dreampm/model/scene.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/random_actions.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/panels/panels.h"
#include "play/app_fixture.h"
#include "play/small_scene.h"

namespace dreampm::play::large_steps_test {
namespace {
using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// All that hands do to water.
const std::vector<std::string> busy{"frames 4",
                                    "push 0.1 0.08 0.12 0.08 3 1 0",
                                    "frames 5",
                                    "release",
                                    "grab 0.1 0.05 0.12 0.05",
                                    "pull 0.2 0.2 0.12",
                                    "frames 6",
                                    "release",
                                    "pour 0.3 0.3 0.12 0.06 0 -1.5 0",
                                    "frames 6",
                                    "pour off",
                                    "drop sphere 0.3 0.3 0.12 0.1",
                                    "frames 5",
                                    "cut 0.2 0.05 0.12 1 0 0 0.4",
                                    "frames 2",
                                    "pin 0.1 0.04 0.12 0.05",
                                    "frames 4",
                                    "erase 0.05 0.02 0.1 0.06",
                                    "frames 2",
                                    "undo",
                                    "frames 2",
                                    "pin off",
                                    "wall x_max 0.3",
                                    "frames 12",
                                    "wall off",
                                    "set gravity.x 3",
                                    "shake 10 0 0",
                                    "frames 6",
                                    "seek 0.2",
                                    "frames 4"};

/// Goes back to 0.25 s and on by 15 frames, twice: the hash after that.
std::uint64_t back_and_on(Playground& p) {
  play(p, {"seek 0.25"});
  const double then = p.frame()->time;
  play(p, {"frames 15"});
  const std::uint64_t once = p.hash();
  // Going back forgets what came after; that moment is kept.
  play(p, {"seek 0.25"});
  EXPECT_NEAR(p.frame()->time, then, 1e-9);
  play(p, {"frames 15"});
  EXPECT_EQ(p.hash(), once);
  return once;
}

TEST(LargeSteps, HandsRepeatThemselvesForAnyNumberOfThreads) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2}) {
    Playground p(large_step_scene(), quiet_options(threads));
    play(p, busy);
    if (threads == 1) one = p.hash();
    EXPECT_EQ(p.hash(), one);
    EXPECT_TRUE(finite(*p.frame()));
    EXPECT_EQ(p.frame()->message_is_error, false) << p.frame()->message;
    EXPECT_LT(p.simulation().steps(), 200U) << "large steps";
  }
}

double middle(Playground& p, int axis) {
  double sum = 0;
  std::size_t count = 0;
  for (const MatterFrame& m : p.frame()->matter)
    for (const Vec3f& x : m.position) sum += static_cast<double>(x[axis]), ++count;
  return sum / static_cast<double>(count);
}

TEST(LargeSteps, APushTakesWaterAlongAndAPinHoldsIt) {
  Playground still(large_step_scene(), quiet_options()), pushed(large_step_scene(), quiet_options()),
      held(large_step_scene(), quiet_options());
  play(still, {"frames 12"});
  play(pushed, {"push 0.06 0.1 0.12 0.3 3 0 0", "frames 12"});
  play(held, {"pin 0.06 0.1 0.12 0.6", "frames 12"});
  EXPECT_GT(middle(pushed, 0), middle(still, 0) + 0.05);
  EXPECT_LT(middle(held, 0), 0.065);
}

TEST(LargeSteps, RigidBodiesAreDroppedFloatAndAreHeld) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2}) {
    Playground p(large_step_scene(), quiet_options(threads));
    play(p, {"frames 2", "drop ball 0.2 0.3 0.12 0.1", "frames 90"});
    const auto center = [&] { return p.simulation().collider("ball-1").pose({0.2, 0.3, 0.12}); };
    // Water is 0.06 m deep, and a ball of a quarter of its density is mostly above it.
    const Vec3d then = center();
    EXPECT_GT(then.y, 0.055);
    EXPECT_LT(then.y, 0.13);
    play(p, {fmt::format("grab {} {} {} 0.05", then.x, then.y, then.z), fmt::format("pull {} 0.3 {}", then.x, then.z),
             "frames 30"});
    EXPECT_GT(center().y, 0.2) << "it is lifted out";
    play(p, {"release", "frames 20", "push 0.2 0.1 0.12 0.15 2 0 0", "frames 10", "release"});
    EXPECT_TRUE(finite(*p.frame()));
    if (threads == 1) one = p.hash();
    EXPECT_EQ(p.hash(), one);
    play(p, {"undo", "undo", "undo"});
    EXPECT_EQ(p.frame()->bodies.size(), 0U);
    EXPECT_FALSE(p.frame()->message_is_error) << p.frame()->message;
  }
}

TEST(LargeSteps, JellyFallsInAndIsHeldAndStiffened) {
  std::uint64_t one = 0;
  for (const int threads : {1, 2}) {
    Playground p(large_step_scene(), quiet_options(threads));
    play(p, {"frames 30", "set matter 3", "drop box 0.2 0.3 0.12 0.1", "frames 20", "grab 0.2 0.1 0.12 0.06",
             "pull 0.2 0.2 0.12", "frames 20", "release", "set material.jelly.youngs_modulus 100000", "frames 20",
             "cut 0.2 0.05 0.12 1 0 0 0.4", "frames 5", "undo", "frames 10"});
    EXPECT_FALSE(p.frame()->message_is_error) << p.frame()->message;
    EXPECT_EQ(p.frame()->matter.size(), 2U);
    EXPECT_TRUE(finite(*p.frame()));
    if (threads == 1) one = p.hash();
    EXPECT_EQ(p.hash(), one);
    // With jelly, too.
    play(p, {"frames 30"});
    back_and_on(p);
  }
}

TEST(LargeSteps, HandsThatDoAnythingLoseNothing) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    RandomActions hands(seed);
    Playground p(large_step_scene(), quiet_options());
    for (int n = 0; n < 60; ++n) {
      const std::shared_ptr<const Frame> frame = p.frame();
      const Action action = hands.next(*frame);
      try {
        p.act(action);
      } catch (const InputError&) {
        // As a person's is, what cannot be done is refused.
      }
      for (int tick = 0; tick < 2; ++tick) p.tick({});
      for (const Frame* side : {&frame->side_a(), &frame->side_b()})
        for (const MatterFrame& matter : side->matter)
          for (const Vec3f& x : matter.position)
            ASSERT_TRUE(x.x >= 0 && x.x <= 0.4001f && x.y >= 0 && x.y <= 0.4001f && x.z >= 0 && x.z <= 0.2401f)
                << "seed " << seed << ", before " << action.text() << ": " << x.x << " " << x.y << " " << x.z;
    }
  }
}

// As one that takes longer than a tick may.
TEST(LargeSteps, WallsComeInwardUntilWaterFillsTheBox) {
  Playground p(large_step_scene(), quiet_options());
  const double all = static_cast<double>(p.frame()->particles) * 8e-6;
  play(p, {"frames 10", "wall x_max 0.2", "wall y_max 0.1", "frames 80"});
  const Vec3d room = p.frame()->room.size();
  EXPECT_GT(room.x * (room.y - 0.04) * room.z, all) << "a layer of cells is left";
  EXPECT_LT(room.x * (room.y - 0.04) * room.z, 1.25 * all);
  EXPECT_TRUE(finite(*p.frame()));
  play(p, {"wall off", "frames 90"});
  EXPECT_NEAR(p.frame()->room.size().x, 0.4, 0.01);
}

TEST(LargeSteps, WhatIsPouredAndErasedIsCounted) {
  Playground p(large_step_scene(), quiet_options());
  const std::size_t first = p.frame()->particles;
  play(p, {"pour 0.3 0.3 0.12 0.06 0 -1.5 0", "frames 20", "pour off"});
  const std::size_t poured = p.frame()->particles;
  // A jet of that radius for a third of a second.
  EXPECT_NEAR(static_cast<double>(poured - first), 3.14 * 0.06 * 0.06 * 1.5 / 3 / 8e-6, 150);
  play(p, {"erase 0.2 0.2 0.12 1"});
  EXPECT_EQ(p.frame()->particles, 0U);
  play(p, {"frames 3", "undo", "frames 3"});
  EXPECT_EQ(p.frame()->particles, poured);
}

TEST(LargeSteps, GoingBackAndOnGivesTheSameBits) {
  Playground p(large_step_scene(), quiet_options());
  play(p, {"frames 30"});
  const std::uint64_t once = back_and_on(p);
  EXPECT_LT(p.frame()->time, 0.4 + 15.0 / 60);
  play(p, {"push 0.1 0.05 0.12 0.1 2 0 0", "frames 3", "release"});
  EXPECT_NE(p.hash(), once);
  play(p, {"undo"});
  EXPECT_EQ(p.hash(), once);
}

int steps_of(Playground& p, int frames) {
  const std::uint64_t before = p.simulation().steps();
  for (int n = 0; n < frames; ++n) p.tick({});
  return static_cast<int>(p.simulation().steps() - before);
}

TEST(LargeSteps, TheSliderOfCellsInAStepTakesThePlaceOfStiffness) {
  Playground p(large_step_scene(), quiet_options());
  std::vector<std::string> ids;
  for (const ControlInfo& c : *p.frame()->controls) ids.push_back(c.id);
  EXPECT_THAT(ids, testing::IsSupersetOf({"cfl", "material.water.viscosity", "material.water.density"}));
  for (const char* none : {"max_compression", "bulk_modulus", "gamma", "tension", "relaxation"})
    EXPECT_THAT(ids, testing::Not(testing::Contains(std::string("material.water.") + none)));
  EXPECT_EQ(value_of(p, "cfl"), 2);
  play(p, {"frames 10"});
  const int usual = steps_of(p, 6);
  play(p, {"seek 0.1", "set cfl 0.5"});
  EXPECT_GE(steps_of(p, 6), 2 * usual);
  EXPECT_EQ(p.simulation().scene().model().time.cfl, 0.5);
  play(p, {"restart", "frames 1"});
  EXPECT_EQ(p.simulation().scene().model().time.cfl, 0.5) << "as it is set";
  play(p, {"undo", "undo"});
  EXPECT_EQ(value_of(p, "cfl"), 2);
  play(p, {"frames 1"});
  EXPECT_EQ(p.simulation().scene().model().time.cfl, 2);
  EXPECT_THAT(refusal(p, "set cfl 4"), HasSubstr("between 0.5 and 3"));
  Playground other(small_scene(), quiet_options());
  EXPECT_THAT(refusal(other, "set cfl 1"), HasSubstr("no control 'cfl'"));
}

TEST(LargeSteps, SlidersOfMatterEndWhereTheSolverDoes) {
  Playground p(large_step_scene(), quiet_options());
  const auto frame = p.frame();
  for (std::size_t i = 0; i < frame->controls->size(); ++i) {
    const ControlInfo& c = (*frame->controls)[i];
    if (!c.id.starts_with("material.") || !c.choices.empty()) continue;
    EXPECT_EQ(frame->live[i].min, c.min) << c.id;
    EXPECT_EQ(frame->live[i].max, c.max) << c.id;
    for (const double end : {c.min, c.max}) {
      p.act({"set", {c.id, text_of(end)}});
      play(p, {"frames 40"});
      EXPECT_NEAR(value_of(p, c.id), end, 1e-6 * end) << c.id;
      EXPECT_FALSE(p.frame()->message_is_error) << p.frame()->message;
    }
    p.act({"set", {c.id, text_of(c.fallback)}});
    play(p, {"frames 40"});
  }
}

TEST(LargeSteps, WhatTheSolverCannotDoIsRefusedInWordsAndChangesNothing) {
  Playground p(large_step_scene(), quiet_options());
  play(p, {"frames 5", "set matter 1"});
  const std::uint64_t before = p.hash();
  EXPECT_THAT(refusal(p, "drop box 0.3 0.3 0.12 0.08"),
              testing::AllOf(HasSubstr("Honey"), HasSubstr("differ in density"), HasSubstr("key S")));
  EXPECT_EQ(p.hash(), before);
  // A jet of what cannot be poured ends at the first drop, and what was there goes on.
  EXPECT_EQ(refusal(p, "pour 0.3 0.3 0.12 0.06 0 -1.5 0"), "");
  play(p, {"frames 2"});
  EXPECT_THAT(p.frame()->message, HasSubstr("Honey"));
  EXPECT_TRUE(finite(*p.frame()));
  const auto refusals = p.frame()->matter_refusals;
  ASSERT_EQ(refusals.size(), matters().size());
  EXPECT_EQ(refusals[0], "");
  EXPECT_THAT(refusals[1], HasSubstr("honey"));
  EXPECT_EQ(refusals[6], "");
}

TEST(LargeSteps, SandAndSnowAreDroppedIntoWaterAndTakenBack) {
  Playground p(large_step_scene(), quiet_options());
  play(p, {"frames 5"});
  const std::uint64_t before = p.hash();
  const std::size_t count = p.frame()->particles;
  play(p, {"set matter 6", "drop box 0.3 0.3 0.12 0.08", "frames 4", "set matter 5", "drop box 0.2 0.3 0.12 0.08",
           "frames 6"});
  EXPECT_GT(p.frame()->particles, count);
  EXPECT_TRUE(finite(*p.frame()));
  play(p, {"undo", "undo"});
  EXPECT_EQ(p.hash(), before);
}

TEST(LargeSteps, SidesAreComparedByTheirNumbers) {
  Playground p(large_step_scene(), quiet_options());
  EXPECT_EQ(compare_with(p.frame()->settings.compare_with).text(), "compare on honey");
  play(p, {"frames 5", "compare on", "frames 5"});
  ASSERT_NE(p.second_simulation(), nullptr);
  EXPECT_EQ(p.second_simulation()->hash(), p.simulation().hash());
  play(p, {"compare side B", "set material.water.viscosity 0.3", "frames 10"});
  EXPECT_NE(p.second_simulation()->hash(), p.simulation().hash());
  EXPECT_NEAR(p.second_simulation()->time(), p.simulation().time(), p.simulation().dt());
  play(p, {"compare off", "restart", "compare on honey", "frames 9"});
  // Honey is where the water was, and falls apart more slowly; it has the look of honey.
  const auto frame = p.frame();
  EXPECT_EQ(frame->side_b().side_name, "honey");
  EXPECT_EQ(frame->side_b().particles, frame->side_a().particles);
  EXPECT_NE(frame->side_b().matter[0].look->refractive_index, frame->side_a().matter[0].look->refractive_index);
  const auto reach = [](const Frame& side) {
    float most = 0;
    for (const Vec3f& x : side.matter[0].position) most = std::max(most, x.x);
    return most;
  };
  EXPECT_LT(reach(frame->side_b()), reach(frame->side_a()) - 0.02f);
  play(p, {"pour 0.3 0.3 0.12 0.06 0 -1.5 0", "frames 6", "pour off", "frames 2", "undo", "compare off", "frames 2"});
  EXPECT_FALSE(p.frame()->message_is_error) << p.frame()->message;
}

TEST(LargeSteps, TheOtherSolverIsAVerbAway) {
  Playground p(load_play_scene("dam-break"), quiet_options());
  const std::size_t many = p.frame()->particles;
  EXPECT_EQ(p.frame()->solver, 1U);
  EXPECT_GT(many, 90000U);
  p.act(Action::parse("solver explicit"));
  EXPECT_EQ(p.frame()->solver, 0U);
  EXPECT_THAT(p.frame()->message, HasSubstr("explicit steps"));
  EXPECT_LT(p.frame()->particles, many / 4) << "as many as it keeps up with";
  EXPECT_THAT(p.frame()->matter_refusals, testing::Each(std::string()));
  p.act(Action::parse("size small"));
  const std::size_t few = p.frame()->particles;
  p.act(Action::parse("solver projection"));
  EXPECT_EQ(p.frame()->size, 0U);
  EXPECT_NEAR(static_cast<double>(p.frame()->particles) / static_cast<double>(many), 0.4, 0.1);
  p.act(Action::parse("solver explicit"));
  EXPECT_EQ(p.frame()->particles, few);
  play(p, {"undo", "undo", "undo", "undo"});
  EXPECT_EQ(p.frame()->particles, many);
  EXPECT_THAT(refusal(p, "solver implicit"), HasSubstr("explicit, projection"));
  p.act(Action::parse("open hourglass"));
  EXPECT_THAT(p.frame()->no_other, HasSubstr("there is no liquid"));
  EXPECT_THAT(refusal(p, "solver projection"), HasSubstr("there is no liquid"));
  EXPECT_EQ(p.frame()->story, "hourglass");
}

TEST(LargeSteps, PressureIsThatOfTheCells) {
  Playground p(large_step_scene("colliders: {shelf: {shape: {box: {min: [0.12, -1, -1], max: [1, 1, 1]}}}}\n"),
               quiet_options());
  play(p, {"frames 30", "set color_by 2"});
  const auto frame = p.frame();
  EXPECT_EQ(frame->value_unit, "Pa");
  double worst = 0;
  for (std::size_t i = 0; i < frame->matter[0].position.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(frame->matter[0].value[i]) -
                                     1000 * 9.81 * (0.2 - static_cast<double>(frame->matter[0].position[i].y))));
  EXPECT_LT(worst, 400) << "a cell of water is 392 Pa";
}

TEST(LargeSteps, WhatIsSavedGoesOnToTheSameBits) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / fmt::format("dreampm-large-steps-{}", ::getpid());
  Playground p(large_step_scene(), quiet_options());
  const std::string file = (folder / "moment.yaml").string();
  play(p, {"set cfl 1", "frames 12", "pour 0.3 0.3 0.12 0.06 0 -1.5 0", "frames 4", "pour off", "frames 1"});
  p.act({"save", {file}});
  Playground on(load_play_scene(file), quiet_options());
  EXPECT_EQ(value_of(on, "cfl"), 1);
  EXPECT_THAT(refusal(on, "solver explicit"), HasSubstr("starts from a moment"));
  for (Playground* one : {&p, &on}) play(*one, {"steps 12"});
  EXPECT_EQ(on.hash(), p.hash());
  std::filesystem::remove_all(folder);
}

// A large step lasts for many pictures then, and none of them stands still.
TEST(LargeSteps, SlowMotionMovesInEachPicture) {
  Playground p(large_step_scene(), quiet_options());
  play(p, {"frames 12", "set speed 0.0625", "frames 2"});
  double before = middle(p, 0);
  int stood = 0;
  double most = 0, least = 1;
  for (int n = 0; n < 48; ++n) {
    p.tick({});
    const double now = middle(p, 0), way = now - before;
    stood += way == 0;
    most = std::max(most, way), least = std::min(least, way), before = now;
  }
  EXPECT_EQ(stood, 0);
  EXPECT_GT(least, 0.4 * most) << "it does not leap";
}

class LargeStepsHand : public AppFixture {
 protected:
  void SetUp() override {
    window_width = 1280, window_height = 1400;
    context.emplace();
    playground.emplace(large_step_scene(), quiet_options());
    play(*playground, {"frames 6"});
    start();
  }
};

TEST_F(LargeStepsHand, ButtonsAndKeysChooseTheSolver) {
  key(solver_key);
  EXPECT_THAT(posted, ElementsAre("solver explicit"));
  posted.clear();
  point_at("solver explicit"), click();
  EXPECT_THAT(posted, ElementsAre("solver explicit"));
  posted.clear();
  point_at("solver projection"), click();
  EXPECT_THAT(posted, IsEmpty()) << "it is that already";
  // Matter that it cannot do is off, by button and key, and says why.
  const RgbImage before = picture();
  point_at("set matter 1"), click();
  EXPECT_THAT(posted, IsEmpty());
  move(900, 700);
  EXPECT_GT(differing(before, picture()), 3000) << "a message";
  key('2');
  EXPECT_THAT(posted, IsEmpty());
  key('1');
  EXPECT_THAT(posted, ElementsAre("set matter 0"));
  posted.clear();
  point_at("cfl", 0.1), click(), rest();
  ASSERT_EQ(posted.size(), 1U);
  EXPECT_THAT(posted[0], testing::StartsWith("set cfl 0.6"));
}

TEST_F(AppFixture, TheOtherSolverIsOffWhereItCannotDo) {
  playground.emplace(load_play_scene("hourglass"), quiet_options());
  start();
  point_at("solver projection"), click();
  EXPECT_THAT(posted, IsEmpty());
  key(solver_key);
  EXPECT_THAT(posted, IsEmpty());
}

}  // namespace
}  // namespace dreampm::play::large_steps_test
