// A and B: the same stage twice, under the same hands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <tuple>

#include "play/small_scene.h"

namespace dreampm::play::compare_test {
namespace {
using namespace test;
using testing::HasSubstr;

/// Particles of a material on a side.
std::size_t count(const Frame& side, const std::string& material) {
  for (const MatterFrame& m : side.matter)
    if (m.name == material) return m.position.size();
  return 0;
}

double mean_height(const Frame& side) {
  double y = 0;
  for (const Vec3f& x : side.matter[0].position) y += static_cast<double>(x.y);
  return y / static_cast<double>(side.matter[0].position.size());
}

TEST(Compare, BIsACopyWithAnotherMatterInPlaceOfTheMainOne) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 8"});
  EXPECT_EQ(p.frame()->other, nullptr);
  const std::uint64_t alone = p.hash();
  play(p, {"compare on honey"});
  const std::shared_ptr<const Frame> frame = p.frame();
  ASSERT_NE(frame->other, nullptr);
  EXPECT_EQ(frame->side, 'A');
  EXPECT_EQ(frame->side_name, "water");
  EXPECT_EQ(frame->other->side_name, "honey");
  EXPECT_EQ(count(frame->side_b(), "honey"), count(frame->side_a(), "water"));
  EXPECT_EQ(count(frame->side_b(), "water"), 0u);
  EXPECT_EQ(count(frame->side_b(), "jelly"), count(frame->side_a(), "jelly"));
  EXPECT_EQ(frame->side_b().time, frame->side_a().time);
  // Where the water is the honey is.
  const auto sorted = [](std::vector<Vec3f> v) {
    std::sort(v.begin(), v.end(),
              [](const Vec3f& a, const Vec3f& b) { return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z); });
    return v;
  };
  EXPECT_EQ(sorted(frame->side_a().matter[0].position), sorted(frame->side_b().matter[2].position));
  EXPECT_NE(p.hash(), alone) << "of both";
  play(p, {"frames 20"});
  EXPECT_NEAR(p.second_simulation()->time(), p.simulation().time(), 2e-3) << "they keep step";
  // To begin anew is to begin with honey.
  play(p, {"restart"});
  EXPECT_EQ(count(p.frame()->side_b(), "honey"), count(p.frame()->side_a(), "water"));
  EXPECT_EQ(p.simulation().time(), 0);
  EXPECT_EQ(p.second_simulation()->time(), 0);
  play(p, {"compare off"});
  EXPECT_EQ(p.frame()->other, nullptr);
  EXPECT_EQ(p.second_simulation(), nullptr);
}

TEST(Compare, TheSameMatterUnderTheSameHandsDoesTheSame) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 4", "compare on", "push 0.06 0.05 0.12 0.08 1 0.5 0", "frames 3", "release", "set matter 3",
           "drop box 0.2 0.3 0.12 0.08", "frames 4", "grab 0.28 0.08 0.12 0.05", "pull 0.3 0.2 0.12", "frames 4",
           "pour 0.1 0.3 0.12 0.03 0 -1.5 0", "set gravity.x 3", "frames 4", "pour off", "cut 0.28 0.08 0.12 0 1 0 0.4",
           "undo", "frames 3"});
  EXPECT_EQ(p.second_simulation()->time(), p.simulation().time());
  EXPECT_EQ(p.second_simulation()->hash(), p.simulation().hash());
}

TEST(Compare, SlidersAreOfTheChosenSide) {
  Playground p(small_scene(), quiet_options());
  play(p, {"compare on", "frames 4", "compare side B", "set material.water.viscosity 20", "frames 30"});
  const std::shared_ptr<const Frame> frame = p.frame();
  EXPECT_EQ(frame->side, 'B');
  EXPECT_EQ(value_of(p, "material.water.viscosity"), 20);
  EXPECT_GT(std::abs(mean_height(frame->side_b()) - mean_height(frame->side_a())), 0.001);
  play(p, {"compare side A"});
  EXPECT_LT(value_of(p, "material.water.viscosity"), 0.01);
  // Settings of the world are of both.
  play(p, {"set gravity.y -3", "compare side B"});
  EXPECT_EQ(value_of(p, "gravity.y"), -3);
}

TEST(Compare, AnEditOfOneSideIsUndoneOnBoth) {
  Playground p(small_scene(), quiet_options());
  play(p, {"compare on", "frames 4", "erase 0.05 0.05 0.1 0.05", "frames 2"});
  const std::uint64_t before = p.hash();
  const double then = p.simulation().time();
  play(p, {"compare side B", "set material.water.viscosity 20", "frames 6", "undo"});
  EXPECT_EQ(p.simulation().time(), then);
  EXPECT_EQ(p.second_simulation()->time(), p.simulation().time());
  EXPECT_EQ(p.hash(), before);
  EXPECT_LT(value_of(p, "material.water.viscosity"), 0.01);
  play(p, {"redo"});
  EXPECT_GT(p.simulation().time(), then);
  play(p, {"undo", "undo"});
  EXPECT_EQ(p.simulation().particle_count(), p.second_simulation()->particle_count());
  EXPECT_THAT(refusal(p, "undo"), HasSubstr("nothing to undo"));
}

// Where stone still stands a crate cannot come in, and where the water was it can.
TEST(Compare, WhatOneSideRefusesTheOtherDoes) {
  Playground p(small_scene(), quiet_options());
  play(p, {"compare on stone", "frames 24", "drop crate 0.07 0.16 0.12 0.06"});
  EXPECT_EQ(p.frame()->side_a().bodies.size(), 1u);
  EXPECT_EQ(p.frame()->side_b().bodies.size(), 0u) << "stone stands as high as it began";
  EXPECT_THAT(p.frame()->message, HasSubstr("B: "));
  play(p, {"undo"});
  EXPECT_EQ(p.frame()->side_a().bodies.size(), 0u);
  EXPECT_FALSE(p.frame()->can_undo);
}

TEST(Compare, ReplaysToTheSameBits) {
  const std::vector<std::string> lines{"frames 3",       "compare on mud",
                                       "frames 5",       "drop sphere 0.2 0.3 0.12 0.08",
                                       "compare side B", "set material.mud.yield_stress 500",
                                       "frames 6",       "seek 0.05",
                                       "frames 4",       "compare on jelly",
                                       "frames 4",       "compare off",
                                       "frames 2"};
  for (const std::size_t end : {lines.size() - 2, lines.size()}) {
    std::uint64_t one = 0;
    for (const int threads : {1, 2}) {
      Playground p(small_scene(), quiet_options(threads));
      play(p, {lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(end)});
      if (threads == 1) one = p.hash();
      EXPECT_EQ(p.hash(), one);
    }
  }
  // Ticks whose steps were counted, with a clock that is short.
  Playground a(small_scene(), quiet_options()), b(small_scene(), quiet_options());
  play(a, {"compare on honey"}), play(b, {"compare on honey"});
  for (int n = 0; n < 4; ++n) b.tick({a.tick({std::nullopt, 2e-3}), {}});
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Compare, OpensAnotherStageForBoth) {
  Playground p(small_scene(), quiet_options());
  play(p, {"compare on honey", "open snowball", "frames 1"});
  const std::shared_ptr<const Frame> frame = p.frame();
  ASSERT_NE(frame->other, nullptr);
  EXPECT_EQ(frame->story, "snowball");
  EXPECT_EQ(frame->other->story, "snowball");
  EXPECT_EQ(frame->side_b().side_name, "honey");
  EXPECT_EQ(frame->side_a().side_name, "snow");
}

TEST(Compare, AJetOfTheMainMatterIsTheOtherOneOnB) {
  Playground p(small_scene(), quiet_options());
  play(p, {"erase 0.2 0.2 0.12 0.5", "drop box 0.2 0.1 0.12 0.08", "compare on honey", "set matter 0",
           "pour 0.2 0.3 0.12 0.03 0 -1.5 0", "frames 5", "pour off"});
  const std::shared_ptr<const Frame> frame = p.frame();
  EXPECT_GT(count(frame->side_a(), "water"), 64u);
  EXPECT_EQ(count(frame->side_b(), "water"), 0u);
  EXPECT_EQ(count(frame->side_b(), "honey"), count(frame->side_a(), "water"));
}

TEST(Compare, SaysWhatIsWrong) {
  Playground p(small_scene(), quiet_options());
  EXPECT_THAT(refusal(p, "compare off"), HasSubstr("nothing is compared"));
  EXPECT_THAT(refusal(p, "compare side B"), HasSubstr("compare on"));
  EXPECT_THAT(refusal(p, "compare on lava"), HasSubstr("there are water, honey"));
  EXPECT_THAT(refusal(p, "compare with honey"), HasSubstr("on, side or off"));
  play(p, {"compare on honey"});
  EXPECT_THAT(refusal(p, "compare side C"), HasSubstr("no C"));
  EXPECT_THAT(refusal(p, "set material.snow.hardening 3"), HasSubstr("no control"));
}

TEST(Compare, KeepsStepInSlowMotion) {
  Playground p(small_scene(), quiet_options());
  play(p, {"compare on", "set speed 0.03125", "frames 200"});
  EXPECT_GT(p.simulation().time(), 0.09);
  EXPECT_EQ(p.second_simulation()->time(), p.simulation().time());
  EXPECT_EQ(p.second_simulation()->hash(), p.simulation().hash());
}

TEST(Compare, ThePastIsThereAgainAfterwards) {
  Playground p(small_scene(), quiet_options());
  play(p, {"frames 12"});
  const std::uint64_t before = p.hash();
  play(p, {"erase 0.05 0.05 0.1 0.05", "frames 12", "compare on honey", "frames 6"});
  EXPECT_THAT(refusal(p, "undo"), HasSubstr("nothing to undo"));
  play(p, {"compare on jelly", "frames 6", "compare off", "frames 6", "undo"});
  EXPECT_EQ(p.hash(), before);
}

TEST(Compare, AFilmIsOneOfTheChosenSide) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "compare-film";
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "a.mp4").string();
  Playground p(small_scene(), quiet_options());
  play(p, {"film " + file, "compare on honey", "frames 2"});
  EXPECT_EQ(p.frame()->film, file);
  play(p, {"compare side B"});
  EXPECT_EQ(p.frame()->film, file) << "it goes on, whichever side is chosen";
  EXPECT_THAT(refusal(p, "film " + (folder / "b.mp4").string()), HasSubstr("is being filmed"));
  // Saved is what is chosen.
  play(p, {"save " + (folder / "b.yaml").string(), "film off"});
  EXPECT_EQ(p.frame()->film, "");
  EXPECT_EQ(load_scene(folder / "b.yaml").materials().back(), "honey");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace dreampm::play::compare_test
