// What panels say and show: messages, words about a control, colors; and pictures off the screen.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "dreampm/play/model/number_text.h"
#include "play/app_fixture.h"

namespace dreampm::play::panel_words_test {
namespace {
using namespace test;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::StartsWith;

/// Pixels as errors are written in.
int orange(const RgbImage& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = image.width / 2; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      count += std::abs(p[0] - 217) < 25 && std::abs(p[1] - 92) < 25 && std::abs(p[2] - 20) < 30;
    }
  return count;
}

class Words : public AppFixture {
 protected:
  void SetUp() override {
    AppFixture::SetUp();
    window_width = 1280, window_height = 720;
    start();
  }
};

TEST_F(Words, AMessageStandsForSecondsAndIsReadAgainInTheMeter) {
  const RgbImage before = picture();
  ASSERT_LT(orange(before), 15);
  playground->tell("1,200 particles left by the top: Undo");
  draw(2);
  const RgbImage said = picture();
  EXPECT_GT(differing(before, said), 3000);
  EXPECT_LT(orange(said), 15) << "it is no error";
  playground->tell("refused", true);
  draw(2);
  EXPECT_GT(orange(picture()), 60);
  input.time += 20;
  draw(2);
  EXPECT_LT(orange(picture()), 15) << "it has gone";
  point_at("meter"), click(), draw(2);
  move(700, 60);
  EXPECT_GT(orange(picture()), 60) << "and is kept";
}

// A line that becomes longer is whole in the first picture of it.
TEST_F(Words, TheMeterIsAsWideAsItsLine) {
  play(*playground, {"set paused 1"});
  draw(3);
  const Place paused = place("meter");
  play(*playground, {"set paused 0", "frames 1"});
  const RgbImage first = picture(), second = picture();
  EXPECT_GT(paused.left - place("meter").left, 6) << "the line is longer";
  EXPECT_EQ(differing(first, second), 0);
}

TEST(Numbers, AreShortWithTheirUnits) {
  EXPECT_EQ(with_unit(2e5, "Pa"), "200 kPa");
  EXPECT_EQ(with_unit(1.5e4, "Pa"), "15 kPa");
  EXPECT_EQ(with_unit(6000, "Pa"), "6000 Pa");
  EXPECT_EQ(with_unit(2.5e9, "Pa"), "2.5 GPa");
  EXPECT_EQ(with_unit(998.2, "kg/m^3"), "998.2 kg/m\u00b3");
  EXPECT_EQ(value_text(5e-4), "0.0005");
  EXPECT_EQ(value_text(15000), "15000");
  EXPECT_EQ(value_text(1e-5), "1e-05");
}

TEST_F(Words, SaveWritesASceneAndSaysWhere) {
  point_at("save"), click();
  ASSERT_THAT(posted, ElementsAre(AllOf(StartsWith("save /"), testing::HasSubstr("/tank"), EndsWith(".yaml"))));
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "play-words";
  std::filesystem::remove_all(folder);
  move(700, 60);
  const RgbImage before = picture();
  playground->act({"save", {(folder / "tank.yaml").string()}});
  EXPECT_TRUE(std::filesystem::exists(folder / "tank.yaml"));
  EXPECT_THAT(playground->frame()->message, AllOf(StartsWith("saved "), testing::HasSubstr("tank.yaml")));
  draw(2);
  const RgbImage after = picture();
  EXPECT_GT(differing(before, after), 3000);
  EXPECT_LT(orange(after), 15);
}

TEST_F(Words, AboutAPaleSliderAreNotPale) {
  playground.emplace(load_play_scene("report", 0), quiet_options());
  window_width = 1280, window_height = 2000;
  start();
  // Of letters on the ground of a tooltip: the darkest pixel that was not there before.
  const auto darkest = [&](const std::string& what) {
    const Place at = place(what);
    move(900, 60), draw(3);
    const RgbImage before = picture();
    point_at(what), draw(60);
    const RgbImage hovered = picture();
    int least = 255;
    for (int y = static_cast<int>(at.bottom) + 2; y < std::min(static_cast<int>(at.bottom) + 120, hovered.height); ++y)
      for (int x = 0; x < hovered.width; ++x) {
        const std::uint8_t *p = hovered.at(x, y), *q = before.at(x, y);
        if (p[0] != q[0]) least = std::min(least, std::max({int{p[0]}, int{p[1]}, int{p[2]}}));
      }
    return least;
  };
  EXPECT_LT(darkest("material.diy.h"), 60) << "Hard is pale: the object is not elastic";
  EXPECT_LT(darkest("material.diy.v"), 60);
}

TEST_F(Words, AColorIsASwatchWithARimAndNoCheckbox) {
  window_width = width, window_height = height;
  for (const char* part : {"red", "green", "blue"})
    playground->act(Action::parse(std::string("set material.jelly.color.") + part + " 1"));
  start();
  const Place swatch = place("material.jelly.color");
  EXPECT_GT(swatch.right - swatch.left, 2.5f * (swatch.bottom - swatch.top));
  const RgbImage image = picture();
  const int y = static_cast<int>(0.5f * (swatch.top + swatch.bottom));
  const auto middle = static_cast<int>(0.5f * (swatch.left + swatch.right));
  for (int c = 0; c < 3; ++c) EXPECT_GT(image.at(middle, y)[c], 250) << "it is white";
  int rim = 255;
  for (int x = static_cast<int>(swatch.left) - 2; x < static_cast<int>(swatch.left) + 3; ++x)
    rim = std::min<int>(rim, image.at(x, y)[0]);
  EXPECT_LT(rim, 225) << "and is seen on white";
}

// A picture that takes seconds is drawn as matter too: pictures off the screen do not hang on the
// machine.
TEST_F(Words, OffTheScreenMatterIsAlwaysDrawnAsMatter) {
  window_width = 1400, window_height = 1400;
  app.reset();
  start();
  app->show_panels(false);
  const auto late = [&] {
    RgbImage last;
    for (int n = 0; n < 4; ++n) {
      input.time += 30;
      app->draw(*playground->frame(), input, window_width, window_height, 1);
      last = app->view();
    }
    return last;
  };
  input.time += 1;
  app->draw(*playground->frame(), input, window_width, window_height, 1);
  const RgbImage first = app->view();
  EXPECT_EQ(differing(first, late()), 0);
  playground->act(Action::parse("set look 1"));
  EXPECT_GT(differing(first, late()), 20000) << "points look otherwise";
}

}  // namespace
}  // namespace dreampm::play::panel_words_test
