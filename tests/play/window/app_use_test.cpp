// The content of the window without a mouse and in small windows: keys that are held, controls by
// keyboard, files that are dropped, hints, and the scale.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "dreampm/play/window/app.h"
#include "play/app_fixture.h"
#include "play/small_scene.h"

namespace dreampm::play::app_use_test {
namespace {
using namespace test;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

TEST_F(AppFixture, ControlsAreReachedByKeyboard) {
  const auto press = [&](Key k) { key(static_cast<int>(k)), draw(2); };
  press(Key::f6);
  std::set<std::string> reached;
  for (int n = 0; n < 40; ++n) {
    press(Key::down);
    EXPECT_THAT(posted, IsEmpty()) << "arrows go from control to control";
    key(' '), draw(2);
    press(Key::right), press(Key::escape);
    for (const std::string& name : taken()) reached.insert(name);
    if (reached.contains("gravity.y")) break;
    // A list or a menu that has opened is left, and what Escape may have ended goes on.
    press(Key::f6);
  }
  EXPECT_THAT(reached, testing::IsSupersetOf({"radius", "strength", "material.water.viscosity", "gravity.y"}));
  key('3');
  EXPECT_THAT(posted, ElementsAre("set matter 2")) << "letters and digits mean what they did";
  posted.clear();
  press(Key::escape), press(Key::escape);
  press(Key::left);
  EXPECT_THAT(posted, ElementsAre("shake -12 0 0"));
}

TEST_F(AppFixture, AFileFallsInWhereItIsDropped) {
  input.files = {"/models/a cup.obj", "/models/b.ply"};
  move(450, 1250);
  ASSERT_EQ(posted.size(), 2U);
  EXPECT_THAT(posted[0], StartsWith("drop \"/models/a cup.obj\" 0."));
  EXPECT_THAT(posted[1], StartsWith("drop /models/b.ply 0."));
  // What is no mesh is opened, or said to be nothing that can be.
  posted.clear();
  const std::filesystem::path scene = std::filesystem::path(testing::TempDir()) / "dropped.yaml";
  std::ofstream(scene) << "dreampm: 1\n";
  input.files = {scene.string(), "/models/letter.odt"};
  move(450, 1250);
  EXPECT_THAT(posted, ElementsAre("open " + scene.string()));
  std::filesystem::remove(scene);
}

TEST_F(AppFixture, OpenListsWhatIsThereAndTakesAPath) {
  window_width = 1280, window_height = 720;
  start();
  point_at("open"), click(), draw(2);
  const auto is_open = [&] {
    return std::any_of(app->places().begin(), app->places().end(),
                       [](const Place& p) { return p.what == "open path"; });
  };
  ASSERT_TRUE(is_open());
  const std::filesystem::path scene = std::filesystem::path(testing::TempDir()) / "typed.yaml";
  std::ofstream(scene) << "dreampm: 1\n";
  input.text = scene.string();
  draw(2);
  key(static_cast<int>(Key::enter)), draw(2);
  EXPECT_THAT(posted, ElementsAre("open " + scene.string()));
  EXPECT_FALSE(is_open());
  std::filesystem::remove(scene);
}

TEST_F(AppFixture, TheMeterUnfoldsOnAClick) {
  window_width = 1280, window_height = 720;
  start();
  const Place line = place("meter");
  EXPECT_LT(line.bottom - line.top, 24) << "one line";
  const RgbImage folded = picture();
  point_at("meter"), click(), draw(2);
  EXPECT_GT(differing(folded, picture()), 20000);
  point_at("meter"), click(), draw(2);
  EXPECT_THAT(posted, IsEmpty());
  move(150, 14);
  EXPECT_LT(differing(folded, picture()), 20000);
}

TEST_F(AppFixture, AClickOverNothingSaysSo) {
  window_width = 1280, window_height = 720;
  playground->act(Action::parse("set tool 5"));
  start();
  move(700, 40);
  const RgbImage before = picture();
  click(), draw(2);
  EXPECT_GT(differing(before, picture()), 3000) << "a message";
}

TEST_F(AppFixture, WhatIsAdvancedIsShownWhereAllIsAskedFor) {
  const auto shown = [&](const std::string& what) {
    return std::any_of(app->places().begin(), app->places().end(), [&](const Place& p) { return p.what == what; });
  };
  EXPECT_TRUE(shown("material.water.viscosity"));
  EXPECT_FALSE(shown("material.water.gamma"));
  point_at("all water"), click();
  EXPECT_TRUE(shown("material.water.gamma"));
  point_at("all water"), click();
  EXPECT_FALSE(shown("material.water.gamma"));
}

TEST_F(AppFixture, TheRewindBarHasRoomInSmallWindows) {
  for (const auto& [w, h] : {std::pair{1280, 720}, {900, 600}, {640, 480}}) {
    window_width = w, window_height = h;
    start();
    const Place bar = place("seek");
    EXPECT_GT(bar.right - bar.left, 140) << w;
    EXPECT_LE(bar.right, static_cast<float>(w));
    for (const char* what : {"save", "open", "render", "open dam-break"})
      EXPECT_LE(place(what).bottom, static_cast<float>(h)) << what << " in " << w;
  }
}

TEST_F(AppFixture, EscapeClosesTheMenuOfFilesWhileItTakesText) {
  const auto is_open = [&] {
    return std::any_of(app->places().begin(), app->places().end(),
                       [](const Place& p) { return p.what == "open path"; });
  };
  point_at("open"), click(), draw(3);
  ASSERT_TRUE(is_open());
  input.text = "no";
  draw(2);
  key(static_cast<int>(Key::escape)), draw();
  EXPECT_FALSE(is_open());
  posted.clear();
  key('3');
  EXPECT_THAT(posted, testing::ElementsAre("set matter 2"));
}

// The frame is the same all the time: what keys ask for counts before a slow solver shows it.
TEST_F(AppFixture, KeysCountBeforeTheNextFrame) {
  app.emplace(
      [this](const Action& a) {
        posted.push_back(a.text());
        return playground->frame()->actions + posted.size();
      },
      1, "test", true);
  draw(3);
  for (const int k : {' ', ' ', ']', ']', 'C'}) key(k);
  const double radius = playground->frame()->settings.radius;
  EXPECT_THAT(posted, testing::ElementsAre("set paused 1", "set paused 0", "set radius " + text_of(radius * 1.25),
                                           "set radius " + text_of(radius * 1.25 * 1.25), "set tool 4"));
  posted.clear();
  move(350, 1000);
  input.left = true;
  draw(2);
  move(550, 1100);
  input.left = false;
  draw(2);
  EXPECT_THAT(posted, testing::Contains(testing::StartsWith("cut ")));
}

TEST_F(AppFixture, AHintFadesOnceItIsFollowed) {
  window_width = 1280, window_height = 700;
  start();
  const auto seen = [&] {
    const RgbImage image = picture();
    int dark = 0;  // letters before the sky
    for (int y = 10; y < 100; ++y)
      for (int x = 320; x < 730; ++x) dark += image.at(x, y)[0] < 70;
    return dark;
  };
  playground->act(Action::parse("erase 0.1 0.1 0.1 0.5"));
  const int all = seen();
  EXPECT_GT(all, 300);
  move(600, 300);
  input.pressed = {'P'};
  draw(2);
  input.released = {'P'};
  draw(120);
  move(330, 500);
  EXPECT_LT(seen(), 0.85 * all) << "who has poured knows how";
  EXPECT_GT(seen(), 0.4 * all) << "the others stay";
}

TEST_F(AppFixture, AHeldKeyRepeatsOnlyWhatOneDoesInARow) {
  const auto held = [&](int key) {
    posted.clear();
    input.repeated = {key, key};
    draw();
    return posted.size();
  };
  for (const int key : {'K', 'R', 'V', 'B', ' ', 'F', '3', 'Q'}) EXPECT_EQ(held(key), 0U) << key;
  held(static_cast<int>(Key::tab));
  EXPECT_FALSE(app->places().empty());
  EXPECT_EQ(held('['), 2U);
  EXPECT_EQ(held('.'), 4U) << "pause and step, twice";
  EXPECT_EQ(held(static_cast<int>(Key::left)), 2U);
  input.control = true;
  EXPECT_EQ(held('Z'), 2U);
}

/// How far the scale reaches: dark pixels of its line, which ends in a tick.
int scale_length(const RgbImage& picture, int left, int bottom) {
  const int y = picture.height - bottom - 14;
  int x = left + 16;
  while (x < picture.width && picture.at(x, y)[0] < 60) ++x;
  return x - left - 16;
}

TEST_F(AppFixture, TheScaleIsThatOfThePictureWhichIsDrawn) {
  window_width = 900, window_height = 1000;
  playground->act(Action::parse("compare on"));
  start();
  const std::shared_ptr<const Frame> frame = playground->frame();
  const RgbImage image = picture();
  const int left = 310, bottom = 157, side = (window_width - left) / 2, high = window_height - bottom;
  gl::Camera seen = camera_of(*frame);
  seen.view_angle =
      2 * std::atan(std::tan(seen.view_angle / 2) * static_cast<float>(std::clamp(1.25 * high / side, 1.0, 2.0)));
  const auto depth =
      static_cast<double>(dot(static_cast<Vec3f>(frame->domain.center()) - seen.eye, seen.axes().forward));
  const double pixels = static_cast<double>(seen.pixels_per_slope(high)) / depth;
  const RoundLength round = round_length((window_width - left) / 5.0 / pixels);
  EXPECT_NEAR(scale_length(image, left, bottom), round.meters * pixels, 3);
}

}  // namespace
}  // namespace dreampm::play::app_use_test
