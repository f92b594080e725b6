// What the report's slider shows, each look by one click, in both presets.
#include "dreampm/play/report/report_looks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "play/small_scene.h"

namespace dreampm::play::report_looks_test {
namespace {
using namespace test;
using testing::HasSubstr;

/// Where a material lies [m]. Sizes are those of the middle 90 % of its particles.
struct Shape {
  double width, height, bottom, top, middle;
};
Shape shape_of(Playground& p, const std::string& material) {
  const std::shared_ptr<const Frame> frame = p.frame();
  for (const MatterFrame& m : frame->matter) {
    if (m.name != material) continue;
    std::vector<double> along[3];
    double sum = 0;
    for (const Vec3f& x : m.position) {
      for (int a = 0; a < 3; ++a) along[a].push_back(static_cast<double>(x[a]));
      sum += static_cast<double>(x.y);
    }
    for (std::vector<double>& a : along) std::sort(a.begin(), a.end());
    const auto at = [&](int a, double share) {
      return along[a][static_cast<std::size_t>(share * static_cast<double>(along[a].size() - 1))];
    };
    const auto size = [&](int a) { return at(a, 0.95) - at(a, 0.05); };
    return {std::max(size(0), size(2)), size(1), at(1, 0), at(1, 1), sum / static_cast<double>(along[1].size())};
  }
  throw std::out_of_range(material);
}

/// Plays a look for `frames` drawn frames, of 25 steps of 0.2 ms, and keeps the most substeps of
/// one.
struct Played {
  Playground p;
  int most_substeps = 0;
  double highest = 0;  ///< of the middle, after it was lowest [m]
  double lowest = 1;

  Played(std::string_view look, std::size_t preset, int frames)
      : p(load_play_scene("report", preset), quiet_options()) {
    play(p, {"look " + std::string(look)});
    for (int n = 0; n < frames; ++n) {
      most_substeps = std::max(most_substeps, p.tick({}));
      const double middle = shape_of(p, "diy").middle;
      if (middle < lowest) lowest = highest = middle;
      highest = std::max(highest, middle);
    }
    EXPECT_NEAR(p.simulation().time(), frames * 25 * 2e-4, 1e-3);
  }
  Shape shape(const std::string& material = "diy") { return shape_of(p, material); }
};

constexpr int second = 200;  ///< drawn frames

/// Substeps that a drawn frame may take: a quarter more than it asks for, and one that it owed.
constexpr int most_substeps = 30;
/// m: of the middle 90 % of a cube of the presets.
constexpr double cube = 0.9 * 0.25;

TEST(ReportLooks, ALiquidFlowsFlatWithinTwoSeconds) {
  Played liquid("liquid", 0, 2 * second);
  const Shape s = liquid.shape();
  EXPECT_GT(s.width, 0.8) << "of a box of 1 m";
  EXPECT_LT(s.height, 0.05);
  EXPECT_LE(liquid.most_substeps, most_substeps);
}

TEST(ReportLooks, HoneyComesToRestAsAPuddle) {
  Played honey("honey", 0, second);
  const Shape at_once = honey.shape();
  EXPECT_GT(at_once.width, 1.5 * cube);
  EXPECT_LT(at_once.width, 0.7) << "the liquid is at the walls by then";
  for (int n = 0; n < second / 2; ++n) honey.p.tick({});
  EXPECT_NEAR(honey.shape().width, at_once.width, 0.05);
  EXPECT_LE(honey.most_substeps, most_substeps);
}

TEST(ReportLooks, StoneKeepsItsShapeAndTheMiddleOfTheSliderADent) {
  Played stone("stone", 0, second / 2);
  EXPECT_NEAR(stone.shape().height, cube, 0.15 * cube);
  EXPECT_NEAR(stone.shape().width, cube, 0.1 * cube);
  Playground p(load_play_scene("report", 0), quiet_options());
  play(p, {"frames 100"});
  EXPECT_EQ(value_of(p, "material.diy.v"), 0.5);
  EXPECT_LT(shape_of(p, "diy").height, stone.shape().height - 0.02);
  EXPECT_GT(shape_of(p, "diy").height, 0.5 * cube);
}

TEST(ReportLooks, WhatIsElasticLeapsAndHasItsShapeAgain) {
  Played elastic("elastic", 0, second);
  EXPECT_GT(elastic.highest - elastic.lowest, 0.1) << "after a fall of 0.35 m";
  EXPECT_NEAR(elastic.shape().height, cube, 0.25 * cube);
  EXPECT_LE(elastic.most_substeps, most_substeps);
}

TEST(ReportLooks, TheRedCubeMeetsEach) {
  // Through the liquid it comes to the floor; what keeps its shape is as wide afterwards.
  std::map<std::string_view, double> bottom, width;
  for (const ReportLook& look : report_looks()) {
    Played played(look.name, 1, 110);
    bottom[look.name] = played.shape("cube").bottom;
    EXPECT_LE(played.most_substeps, 2 * most_substeps) << look.name;
    width[look.name] = played.shape().width;
  }
  EXPECT_LT(bottom["liquid"], 0.06);
  EXPECT_GT(width["liquid"], 0.8);
  EXPECT_GT(width["honey"], 0.4);
  // The cube stands on an edge of it and falls off; the stone stays as it was.
  EXPECT_NEAR(width["stone"], cube, 0.1 * cube);
  EXPECT_GT(bottom["elastic"], 0.1);
}

TEST(ReportLooks, ALookIsOneEditThatSetsEverySliderOfIt) {
  for (const int restarts : {1, 0}) {
    Playground p(load_play_scene("report", 1), quiet_options());
    play(p, {"frames 10", "set auto_restart " + std::to_string(restarts), "look elastic", "frames 20", "look stone",
             "frames 20"});
    EXPECT_EQ(p.simulation().time() < 0.15, restarts == 1);
    for (const ReportLook::Value& v : report_look("stone").values())
      EXPECT_EQ(value_of(p, "material.diy." + std::string(v.key)), v.value) << v.key;
    play(p, {"undo"});
    EXPECT_EQ(value_of(p, "material.diy.elastic"), 1);
    play(p, {"undo"});
    EXPECT_EQ(value_of(p, "material.diy.v"), 0.5);
  }
}

TEST(ReportLooks, RefusesWhatIsNone) {
  Playground report(load_play_scene("report", 0), quiet_options()), tank(small_scene(), quiet_options());
  EXPECT_THAT(refusal(report, "look slime"), HasSubstr("no look 'slime'; there are liquid, honey, stone, elastic"));
  EXPECT_THAT(refusal(tank, "look honey"), HasSubstr("open report 1"));
}

}  // namespace
}  // namespace dreampm::play::report_looks_test
