// The content of the window, clicked where its controls stand: what each of them posts.
#include "dreampm/play/window/app.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/report/report_looks.h"
#include "play/app_fixture.h"
#include "play/small_scene.h"

namespace dreampm::play::app_test {
namespace {
using namespace test;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST_F(AppFixture, EveryButtonPostsWhatItSays) {
  std::vector<std::string> buttons{"restart", "undo"};
  for (std::size_t n = 0; n < matters().size(); ++n) buttons.push_back(fmt::format("set matter {}", n));
  for (std::size_t n = 0; n < tool_names().size(); ++n) buttons.push_back(fmt::format("set tool {}", n));
  for (const std::string& what : buttons) {
    point_at(what);
    EXPECT_THAT(posted, IsEmpty()) << what << " before the click";
    click();
    EXPECT_THAT(posted, ElementsAre(what));
    posted.clear();
    rest();
  }
  point_at("set paused 1"), click();
  EXPECT_THAT(posted, ElementsAre("set paused 1"));
  posted.clear(), rest();
  point_at("step"), click();
  EXPECT_THAT(posted, ElementsAre("set paused 1", "step"));
  posted.clear();
  point_at("redo"), click();
  EXPECT_THAT(posted, IsEmpty()) << "there is nothing to redo";
}

TEST_F(AppFixture, EveryStoryAndPresetHasAButtonThatOpensIt) {
  window_width = 2000, window_height = 400;
  start();
  std::vector<std::string> buttons{"open report 1", "open report 2"};
  for (const Story& s : stories()) buttons.push_back(fmt::format("open {}", s.name));
  for (const std::string& what : buttons) {
    point_at(what);
    click();
    EXPECT_THAT(posted, ElementsAre(what));
    posted.clear();
    rest();
  }
}

TEST_F(AppFixture, EachLookOfTheReportIsOneClick) {
  playground.emplace(load_play_scene("report", 1), quiet_options());
  start();
  for (const ReportLook& look : report_looks()) {
    const std::string what = fmt::format("look {}", look.name);
    point_at(what), click();
    EXPECT_THAT(posted, ElementsAre(what));
    posted.clear();
    rest();
  }
}

TEST_F(AppFixture, EveryControlStandsOnceAndSetsItselfOnly) {
  for (const char* material : {"water", "jelly"})
    for (const Place& p : app->places())
      if (p.what == std::string("all ") + material) {
        point_at(p.what), click(), rest();
        break;
      }
  const std::shared_ptr<const Frame> frame = playground->frame();
  std::map<std::string, int> drawn;
  for (const Place& p : app->places()) {
    ++drawn[p.what];
    EXPECT_LE(p.bottom, static_cast<float>(window_height)) << p.what;
    for (const Place& o : app->places()) {
      if (&o >= &p) continue;
      EXPECT_FALSE(o.left < p.right && p.left < o.right && o.top < p.bottom && p.top < o.bottom)
          << o.what << " and " << p.what << " stand on each other";
    }
  }
  for (std::size_t i = 0; i < frame->controls->size(); ++i) {
    const ControlInfo& c = (*frame->controls)[i];
    SCOPED_TRACE(c.id);
    if (c.id == "matter" || c.id == "tool") continue;  // buttons
    const std::string what = c.color.empty() ? c.id : c.color;
    ASSERT_EQ(drawn[what], 1);
    if (!c.color.empty()) continue;
    if (c.is_switch()) {
      point_at(what, 0.1);
      EXPECT_THAT(posted, IsEmpty());
      click();
      EXPECT_THAT(posted, ElementsAre(fmt::format("set {} {}", c.id, frame->values[i] == 0 ? 1 : 0)));
    } else if (c.choices.empty()) {
      playground->act({"set", {c.id, text_of(0.5 * (c.min + c.max))}});
      // From one end of the slider to the other, with Shift: as far as it goes.
      input.shift = true;
      point_at(what, 0.02);
      EXPECT_THAT(posted, IsEmpty());
      input.left = true;
      draw(2);
      const Place p = place(what);
      move(static_cast<double>(p.left) - 50, static_cast<double>(p.top));
      ASSERT_THAT(posted, Not(IsEmpty()));
      EXPECT_EQ(Action::parse(posted.back()).number(1), c.min);
      move(static_cast<double>(p.right) + 50, static_cast<double>(p.bottom) + 60);
      EXPECT_EQ(Action::parse(posted.back()).number(1), c.max) << "and no other control takes over";
      input.left = false;
      draw(2);
      EXPECT_THAT(taken(), ElementsAre(c.id));
      draw(3);
      EXPECT_THAT(posted, IsEmpty()) << "after the button is up";
      input.shift = false;
    } else {
      point_at(what, 0.2), click();
      EXPECT_THAT(posted, IsEmpty()) << "the list opens";
      // The second choice stands a line and a half below.
      const Place p = place(what);
      move(input.x, static_cast<double>(p.bottom) + 1.5 * static_cast<double>(p.bottom - p.top));
      click();
      EXPECT_THAT(taken(), ElementsAre(c.id));
    }
    posted.clear();
    rest();
  }
}

TEST_F(AppFixture, AColorOfOneMaterialLeavesTheOthersAlone) {
  playground->act(Action::parse("set matter 5"));
  playground->act(Action::parse("drop box 0.1 0.3 0.12 0.06"));
  start();
  std::set<std::string> colors;
  for (const Place& p : app->places())
    if (p.what.ends_with(".color")) colors.insert(p.what);
  ASSERT_GE(colors.size(), 2u);
  for (const std::string& what : colors) {
    start();
    point_at(what, 0.05), click();
    // The square of the color picker opens under the button.
    const Place p = place(what);
    move(static_cast<double>(p.left) + 60, static_cast<double>(p.bottom) + 60);
    click();
    const std::set<std::string> set = taken();
    EXPECT_FALSE(set.empty()) << what;
    EXPECT_THAT(set, Each(StartsWith(what + ".")));
  }
}

TEST_F(AppFixture, ADoubleClickResetsASliderAndSetsNothingBefore) {
  point_at("gravity.y", 0.1);
  click();
  click();
  EXPECT_THAT(posted, ElementsAre("set gravity.y -9.81"));
  draw(60);
  EXPECT_THAT(posted, ElementsAre("set gravity.y -9.81"));
}

TEST_F(AppFixture, AClickOnASliderSetsItOnceItIsNoDoubleOne) {
  point_at("gravity.y", 0.1);
  click();
  EXPECT_THAT(posted, IsEmpty());
  draw(60);
  ASSERT_EQ(posted.size(), 1U);
  EXPECT_LT(Action::parse(posted[0]).number(1), -5);
}

TEST_F(AppFixture, EscapeClosesListsAndMenusAndTheNextClickIsOfThePicture) {
  const auto clicks_into_the_picture = [&] {
    posted.clear();
    move(450, 900);
    click(), rest();
    return posted;
  };
  const std::vector<std::string> plain = clicks_into_the_picture();
  point_at("look", 0.2), click();
  key(static_cast<int>(Key::escape)), draw(2);
  EXPECT_EQ(clicks_into_the_picture(), plain) << "after a list";
  point_at("gravity.y", 0.2), click(&Input::right), draw(2);
  key(static_cast<int>(Key::escape)), draw(2);
  EXPECT_EQ(clicks_into_the_picture(), plain) << "after a menu";
}

TEST_F(AppFixture, EachDragIsAnEditOfItsOwn) {
  for (int drag = 1; drag <= 2; ++drag) {
    point_at("gravity.y", 0.2);
    input.left = true;
    draw(2);
    move(input.x + 20, input.y), move(input.x + 20, input.y);
    EXPECT_EQ(ended, drag - 1) << "while it lasts";
    input.left = false;
    draw(2);
    EXPECT_EQ(ended, drag);
    rest();
  }
  point_at("set matter 3"), click();
  EXPECT_EQ(ended, 2) << "what changes nothing in the world is no edit";
}

TEST_F(AppFixture, AControlClickTakesATypedNumber) {
  point_at("gravity.y", 0.1);
  input.control = true;
  click();
  input.control = false;
  draw();
  EXPECT_THAT(posted, IsEmpty());
  // The number that stands there is chosen, and typing replaces it.
  for (const std::string typed : {"-", "3", ".", "5"}) {
    input.text = typed, input.pressed = {typed[0]};
    draw();
    input.released = {typed[0]};
    draw();
  }
  key(static_cast<int>(Key::enter));
  draw(2);
  ASSERT_THAT(posted, Not(IsEmpty()));
  EXPECT_EQ(posted.back(), "set gravity.y -3.5");
  EXPECT_THAT(taken(), ElementsAre("gravity.y")) << "digits that are typed choose no matter";
  key('3');
  EXPECT_THAT(posted, ElementsAre("set matter 2")) << "but after Enter they do";
  // What is beyond the slider's ends is taken to its end.
  posted.clear();
  rest();
  point_at("gravity.y", 0.1);
  input.control = true;
  click();
  input.control = false;
  input.text = "900";
  draw();
  // On a slow machine a key comes and goes between two pictures.
  input.pressed = input.released = {static_cast<int>(Key::enter)};
  draw();
  key('3');
  EXPECT_EQ(posted.back(), "set matter 2") << "Enter came through";
  posted.pop_back();
  ASSERT_THAT(posted, Not(IsEmpty()));
  EXPECT_EQ(posted.back(), "set gravity.y 10");
}

TEST_F(AppFixture, ARightClickTellsAndPostsNothing) {
  const std::shared_ptr<const Frame> frame = playground->frame();
  for (const std::string what : {"gravity.y", "dark", "look", "material.water.viscosity"}) {
    point_at(what, 0.2);
    const RgbImage before = picture();
    click(&Input::right);
    draw(2);
    EXPECT_THAT(posted, IsEmpty()) << what;
    // The hints of the first minute, the meters and the ring change by themselves; not so much.
    EXPECT_GT(differing(before, picture()), 2000) << "its text is shown";
    // A click elsewhere closes it.
    move(width - 20, 900);
    click();
    rest();
    EXPECT_THAT(posted, IsEmpty()) << what;
  }
}

TEST_F(AppFixture, AHeadingFoldsItsControlsAway) {
  point_at("heading World"), click();
  const auto shown = [&](const std::string& what) {
    return std::any_of(app->places().begin(), app->places().end(), [&](const Place& p) { return p.what == what; });
  };
  EXPECT_FALSE(shown("gravity.y"));
  EXPECT_TRUE(shown("speed"));
  EXPECT_THAT(posted, IsEmpty());
}

TEST_F(AppFixture, TheTiltSetsGravityAndNothingElse) {
  point_at("tilt", 0.8);
  input.left = true;
  draw(2);
  move(input.x + 300, input.y);
  input.left = false;
  draw(2);
  EXPECT_THAT(taken(), ElementsAre("gravity.x", "gravity.y", "gravity.z"));
}

TEST_F(AppFixture, KeysDoWhatTheHelpPageSays) {
  const std::vector<std::pair<int, std::string>> all{
      {'1', "set matter 0"}, {'2', "set matter 1"},     {'3', "set matter 2"},     {'4', "set matter 3"},
      {'5', "set matter 4"}, {'6', "set matter 5"},     {'7', "set matter 6"},     {'8', "set matter 7"},
      {'9', "set matter 8"}, {'0', "set matter 9"},     {'Q', "set tool 0"},       {'G', "set tool 1"},
      {'O', "set tool 2"},   {'D', "set tool 3"},       {'C', "set tool 4"},       {'E', "set tool 5"},
      {'N', "set tool 6"},   {'W', "set tool 7"},       {' ', "set paused 1"},     {'R', "restart"},
      {'B', "set dark 1"},   {'K', "compare on honey"}, {'[', "set radius 0.064"}, {'M', "size large"}};
  for (const auto& [pressed, line] : all) {
    key(pressed);
    EXPECT_THAT(posted, ElementsAre(line)) << pressed;
    posted.clear();
  }
  key('V');
  EXPECT_THAT(posted, ElementsAre("film tank-001.mp4"));
  posted.clear();
  key('Z'), key('Y');
  EXPECT_THAT(posted, IsEmpty());
  input.control = true;
  key('Z'), key('Y');
  EXPECT_THAT(posted, ElementsAre("undo", "redo"));
  posted.clear();
  input.control = false;
  key(static_cast<int>(Key::left));
  EXPECT_THAT(posted, ElementsAre("shake -12 0 0"));
  posted.clear();
  EXPECT_FALSE(app->places().empty());
  key(static_cast<int>(Key::tab));
  EXPECT_TRUE(app->places().empty()) << "hidden";
  key(static_cast<int>(Key::tab));
  EXPECT_FALSE(app->places().empty());
  window_width = 800, window_height = 600;
  draw();
  const RgbImage before = picture();
  key(static_cast<int>(Key::f1));
  draw(2);
  EXPECT_GT(differing(before, picture()), 20000) << "the page of keys";
  key(static_cast<int>(Key::escape));
  EXPECT_FALSE(app->wants_picture());
  key(static_cast<int>(Key::f12));
  EXPECT_TRUE(app->wants_picture());
  EXPECT_THAT(posted, IsEmpty());
}

TEST_F(AppFixture, AComparisonHasItsButtonsAndAPictureOfEachSide) {
  playground->act(Action::parse("set compare_with 2"));
  draw();
  key('X');
  EXPECT_THAT(posted, IsEmpty()) << "there is one side";
  point_at("compare on honey"), click();
  EXPECT_THAT(posted, ElementsAre("compare on honey"));
  posted.clear();
  key('K');
  EXPECT_THAT(posted, ElementsAre("compare on honey"));
  posted.clear();
  rest();
  window_width = 900, window_height = 1400;
  start();
  const RgbImage alone = picture();
  playground->act(Action::parse("compare on honey"));
  start();
  for (const std::string what : {"compare side A", "compare side B", "compare off"}) {
    point_at(what), click();
    EXPECT_THAT(posted, ElementsAre(what));
    posted.clear();
    rest();
  }
  key('X'), key('K');
  EXPECT_THAT(posted, ElementsAre("compare side B", "compare off"));
  posted.clear();
  move(350, 400);
  const RgbImage both = picture(), view = app->view();
  EXPECT_GT(differing(alone, both), 100000);
  EXPECT_EQ(view.width, 2 * ((900 - 310) / 2));
  // The hand acts where it is, on either half: on the matter at the same place.
  const auto pressed_at = [&](double x) {
    posted.clear();
    move(x, 760);
    input.left = true, draw(), move(x + 4, 750), input.left = false, draw();
    for (const std::string& line : posted)
      if (line.starts_with("grab")) return line;
    return std::string();
  };
  const int half = (900 - 310) / 2;
  double found = 0;
  std::string left;
  for (double x = 20; x < half - 20 && left.empty(); x += 15) left = pressed_at(310 + x), found = x, rest();
  ASSERT_FALSE(left.empty());
  EXPECT_EQ(pressed_at(310 + half + found), left);
}

TEST_F(AppFixture, PourEndsWhenTheKeyIsUpWhateverHappened) {
  move(450, 1250);
  input.pressed = {'P'};
  draw(2);
  EXPECT_THAT(posted, Contains(StartsWith("pour 0.")));
  posted.clear();
  // The pointer leaves the window, and a window that loses its focus has its keys released.
  input.inside = false;
  draw(2);
  input.released = {'P'};
  draw(2);
  EXPECT_THAT(posted, Contains("pour off"));
}

TEST_F(AppFixture, WindowsOfAnySizeAreDrawn) {
  for (const auto& [w, h] :
       std::vector<std::pair<int, int>>{{1, 1}, {2, 900}, {900, 2}, {310, 98}, {496, 316}, {497, 319}, {3000, 40}}) {
    window_width = w, window_height = h;
    draw(2);
    const RgbImage drawn = picture();
    EXPECT_EQ(drawn.width, w);
    EXPECT_EQ(drawn.height, h);
    EXPECT_EQ(app->places().empty(), w < 496 || h < 318) << w << 'x' << h;
    move(0.5 * w, 0.5 * h), click(), rest();
    key(static_cast<int>(Key::f1)), key(static_cast<int>(Key::f1));
  }
}

}  // namespace
}  // namespace dreampm::play::app_test
