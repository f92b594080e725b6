// What moves and buttons mean in the picture.
#include "dreampm/play/tools/cursor.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "play/small_scene.h"

namespace dreampm::play::pointer_test {
namespace {
using namespace test;

/// A pointer over a playground, and what it posted.
struct AppFixture {
  Playground playground{small_scene(), quiet_options()};
  std::vector<Action> posted;
  Cursor pointer{[this](Action a) {
    posted.push_back(a);
    playground.act(a);
    return std::uint64_t{posted.size()};
  }};
  double time = 0;
  AppFixture() {
    pointer.resize(800, 600);
    pointer.reset_camera(*playground.frame());
  }
  void move_to(const Vec3d& at) {
    const auto p = pointer.camera().project(static_cast<Vec3f>(at), 800, 600);
    ASSERT_TRUE(p.has_value());
    pointer.move(*playground.frame(), static_cast<double>(p->x), static_cast<double>(p->y), time += 0.02);
  }
  bool did(std::string_view verb) const {
    return std::any_of(posted.begin(), posted.end(), [&](const Action& a) { return a.verb == verb; });
  }
  std::shared_ptr<const Frame> frame() { return playground.frame(); }
};

TEST(Cursor, FindsMatterBeforeTheFloorAndTheFloorBeforeNothing) {
  AppFixture hand;
  const auto frame = hand.frame();
  const auto at = [&](const Vec3d& place) {
    const auto p = hand.pointer.camera().project(static_cast<Vec3f>(place), 800, 600);
    return pick(*frame, hand.pointer.camera().ray(p->x, p->y, 800, 600));
  };
  const Hit cube = at({0.28, 0.12, 0.12});
  EXPECT_TRUE(cube.matter);
  EXPECT_LT(length(cube.at - Vec3d{0.28, 0.12, 0.12}), 0.08);
  const Hit floor = at({0.38, 0, 0.22});
  EXPECT_FALSE(floor.matter);
  EXPECT_LT(length(floor.at - Vec3d{0.38, 0, 0.22}), 0.01);
}

// Of a few particles a dragon would be crumbs: it is as large as the box has room for.
TEST(Cursor, ADragonThatIsDroppedIsLargeEnoughToBeOne) {
  AppFixture hand;
  hand.playground.act(Action::parse("set tool 3"));
  const auto dropped = [&](const std::string& name) {
    const auto at = std::find(drop_names().begin(), drop_names().end(), name) - drop_names().begin();
    hand.playground.act({"set", {"drop", std::to_string(at)}});
    hand.move_to({0.2, 0, 0.12});
    hand.pointer.press(*hand.frame(), Cursor::Button::left);
    hand.pointer.release(Cursor::Button::left);
    EXPECT_EQ(hand.posted.back().verb, "drop");
    EXPECT_EQ(hand.posted.back().word(0), name);
    return hand.posted.back().number(4);
  };
  EXPECT_NEAR(dropped("box"), 0.16, 1e-9);
  EXPECT_NEAR(dropped("dragon"), 0.8 * 0.24, 1e-9) << "24 spacings would be 0.48 m";
}

TEST(Cursor, HoveringPushesAndLeavingLetsGo) {
  AppFixture hand;
  for (int n = 0; n < 5; ++n) hand.move_to({0.03 + 0.015 * n, 0.16, 0.12});
  EXPECT_TRUE(hand.did("push"));
  ASSERT_TRUE(hand.pointer.mark().has_value());
  hand.pointer.leave();
  EXPECT_EQ(hand.posted.back().verb, "release");
  EXPECT_FALSE(hand.pointer.mark().has_value());
}

TEST(Cursor, ADragOnMatterGrabsAndElsewhereTurnsTheView) {
  AppFixture hand;
  hand.move_to({0.28, 0.12, 0.12});
  hand.pointer.press(*hand.frame(), Cursor::Button::left);
  EXPECT_TRUE(hand.did("grab"));
  hand.move_to({0.28, 0.22, 0.12});
  EXPECT_TRUE(hand.did("pull"));
  hand.pointer.release(Cursor::Button::left);
  EXPECT_EQ(hand.posted.back().verb, "release");

  const Vec3f eye = hand.pointer.camera().eye;
  hand.pointer.move(*hand.frame(), 790, 10, hand.time += 0.02);
  const std::size_t posted = hand.posted.size();
  hand.pointer.press(*hand.frame(), Cursor::Button::left);
  hand.pointer.move(*hand.frame(), 700, 60, hand.time += 0.02);
  hand.pointer.release(Cursor::Button::left);
  EXPECT_FALSE(hand.pointer.camera().eye == eye);
  EXPECT_EQ(hand.posted.size(), posted) << "the matter knows nothing of it";
  const float far = hand.pointer.camera().distance();
  hand.pointer.wheel(3);
  EXPECT_LT(hand.pointer.camera().distance(), far);
}

TEST(Cursor, EachToolDoesWhatItSays) {
  const std::pair<std::string_view, std::string_view> tools[] = {{"push", "grab"}, {"grab", "grab"}, {"pour", "pour"},
                                                                 {"drop", "drop"}, {"cut", "cut"},   {"erase", "erase"},
                                                                 {"pin", "pin"},   {"walls", "wall"}};
  ASSERT_EQ(std::size(tools), tool_names().size());
  for (std::size_t t = 0; t < std::size(tools); ++t) {
    EXPECT_EQ(tool_names()[t], tools[t].first);
    AppFixture hand;
    hand.playground.act({"set", {"tool", text_of(static_cast<double>(t))}});
    hand.playground.act({"set", {"radius", "0.05"}});
    hand.move_to({0.28, 0.12, 0.12});
    hand.pointer.press(*hand.frame(), Cursor::Button::left);
    hand.move_to({0.3, 0.1, 0.12});
    hand.pointer.release(Cursor::Button::left);
    EXPECT_TRUE(hand.did(tools[t].second)) << tools[t].first;
    for (int n = 0; n < 3; ++n) hand.playground.tick({});
    const std::string message = hand.frame()->message;
    EXPECT_TRUE(tools[t].first == "cut" ? message.starts_with("cut: ") : message.empty()) << message;
  }
}

TEST(Cursor, AJetStaysWhereThePointerIsWhileItFalls) {
  AppFixture hand;
  hand.move_to({0.2, 0.02, 0.18});
  hand.pointer.hold("pour", true);
  const auto jet = [&] {
    for (auto a = hand.posted.rbegin(); a != hand.posted.rend(); ++a)
      if (a->verb == "pour" && a->words.size() > 1) return Vec3d{a->number(0), a->number(1), a->number(2)};
    return Vec3d{};
  };
  const Vec3d first = jet();
  for (int n = 0; n < 30; ++n) {
    hand.playground.tick({});
    hand.move_to({0.2, 0.02, 0.18});
  }
  EXPECT_LT(length(jet() - first), 0.01) << "the stream itself is not aimed at";
  hand.move_to({0.3, 0.02, 0.1});
  EXPECT_GT(length(jet() - first), 0.08);
  hand.pointer.hold("pour", false);
  EXPECT_EQ(hand.posted.back().words, std::vector<std::string>{"off"});
}

TEST(Cursor, RightDragsShiftTheViewAndTurnItWithShift) {
  AppFixture hand;
  const gl::Camera before = hand.pointer.camera();
  hand.move_to({0.2, 0.02, 0.18});
  hand.pointer.press(*hand.frame(), Cursor::Button::right);
  hand.pointer.move(*hand.frame(), 500, 400, hand.time += 0.02);
  hand.pointer.release(Cursor::Button::right);
  const gl::Camera shifted = hand.pointer.camera();
  EXPECT_LT(length((shifted.eye - before.eye) - (shifted.target - before.target)), 1e-5f);
  EXPECT_GT(length(shifted.eye - before.eye), 0.01f);
  hand.pointer.press(*hand.frame(), Cursor::Button::right, true);
  hand.pointer.move(*hand.frame(), 560, 400, hand.time += 0.02);
  hand.pointer.release(Cursor::Button::right);
  EXPECT_LT(length(hand.pointer.camera().target - shifted.target), 1e-5f);
  EXPECT_GT(length(hand.pointer.camera().eye - shifted.eye), 0.01f);
}

}  // namespace
}  // namespace dreampm::play::pointer_test
