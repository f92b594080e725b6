// A window without a screen, and a hand before it, for tests of what panels do.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dreampm/gl/headless.h"
#include "dreampm/play/window/app.h"
#include "play/small_scene.h"

namespace dreampm::play::test {

/// What it posts is kept, and not done: each click
/// meets the same frame.
class AppFixture : public testing::Test {
 protected:
  /// As narrow as panels are shown in, and so high that nothing is scrolled away.
  static constexpr int width = 600, height = 2600;

  void SetUp() override {
    context.emplace();
    playground.emplace(small_scene(), quiet_options());
    play(*playground, {"frames 12", "erase 0.1 0.1 0.1 0.02"});
    start();
  }
  void TearDown() override { app.reset(); }

  void start() {
    app.reset();
    posted.clear();
    input = {};
    app.emplace(
        [this](const Action& a) {
          // The end of an edit has a test of its own.
          if (a.verb == "done")
            ++ended;
          else
            posted.push_back(a.text());
          return std::uint64_t{0};
        },
        1, "test", true);
    draw(3);
  }
  void draw(int times = 1) {
    for (int n = 0; n < times; ++n) {
      input.time += 1.0 / 60;
      app->update(*playground->frame(), input, window_width, window_height, 1);
      input.pressed.clear(), input.repeated.clear(), input.released.clear(), input.text.clear();
      input.files.clear(), input.wheel = 0;
    }
  }
  RgbImage picture() {
    input.time += 1.0 / 60;
    app->draw(*playground->frame(), input, window_width, window_height, 1);
    return app->picture();
  }
  /// Long enough after the last click that it is no double one.
  void rest() {
    input.time += 1;
    draw();
  }
  void move(double x, double y) {
    input.inside = true, input.x = x, input.y = y;
    draw(2);
  }
  Place place(const std::string& what) {
    for (const Place& p : app->places())
      if (p.what == what) return p;
    ADD_FAILURE() << "nothing named '" << what << "' is drawn";
    return {};
  }
  /// Into its middle, or at that share of its width.
  void point_at(const std::string& what, double share = 0.5) {
    const Place p = place(what);
    move(static_cast<double>(p.left) + share * static_cast<double>(p.right - p.left),
         0.5 * static_cast<double>(p.top + p.bottom));
  }
  void click(bool Input::* button = &Input::left) {
    input.*button = true;
    draw(2);
    input.*button = false;
    draw(2);
  }
  void key(int key) {
    input.pressed = {key};
    draw();
    input.released = {key};
    draw();
  }
  /// The names that were set since the last call.
  std::set<std::string> taken() {
    std::set<std::string> names;
    for (const std::string& line : posted) {
      const Action a = Action::parse(line);
      names.insert(a.verb == "set" ? a.words.at(0) : line);
    }
    posted.clear();
    return names;
  }

  static int differing(const RgbImage& a, const RgbImage& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] != b.pixels.at(i);
    return count;
  }

  std::optional<gl::HeadlessContext> context;
  std::optional<Playground> playground;
  std::optional<App> app;
  Input input;
  std::vector<std::string> posted;
  int ended = 0;  ///< edits
  int window_width = width, window_height = height;
};

}  // namespace dreampm::play::test
