// Films of what is shown.
#include "dreampm/play/window/recorder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/play/window/app.h"
#include "dreampm/play/window/headless.h"
#include "dreampm/play/window/picture_films.h"
#include "play/small_scene.h"
#include "video/decoded.h"

namespace dreampm::play::recorder_test {
namespace {
using namespace test;
using dreampm::test::decode;
using dreampm::test::Decoded;

RgbImage plain(int width, int height, std::uint8_t level) {
  RgbImage image(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), level);
  return image;
}

/// Pixels of the ring about the pointer.
int yellow(const RgbImage& image) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += 3)
    count += image.pixels[i] > 180 && image.pixels[i + 1] > 120 && image.pixels[i + 2] < image.pixels[i + 1] - 50;
  return count;
}

class Recording : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("recording-{}", ::getpid());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::filesystem::path folder;
};

TEST_F(Recording, IsAsFastAsTheClock) {
  const std::filesystem::path file = folder / "film.mp4";
  Recorder recorder(file, 30);
  // Pictures of a slow machine stand, those of a quick one are left out.
  recorder.add(plain(64, 48, 40), 7.0);
  recorder.add(plain(64, 48, 80), 7.5);
  for (int n = 0; n <= 50; ++n) recorder.add(plain(64, 48, 200), 7.5 + n * 0.01);
  EXPECT_NEAR(recorder.seconds(), 1.0, 0.05);
  recorder.finish();
  const Decoded film = decode(file);
  EXPECT_EQ(film.frames_a_second, 30);
  ASSERT_EQ(film.frames.size(), 31U);
  EXPECT_NEAR(film.frames[0].at(20, 20)[0], 40, 4);
  EXPECT_NEAR(film.frames[14].at(20, 20)[0], 40, 4);
  EXPECT_NEAR(film.frames[18].at(20, 20)[0], 200, 4);
}

TEST_F(Recording, StandsStillWhileNothingIsDrawn) {
  Recorder recorder(folder / "film.mp4", 30);
  recorder.add(plain(64, 48, 40), 7.0);
  recorder.add(plain(64, 48, 80), 607.0);
  EXPECT_NEAR(recorder.seconds(), Recorder::longest_stand, 0.1);
  recorder.add(plain(64, 48, 80), 608.0);
  EXPECT_NEAR(recorder.seconds(), Recorder::longest_stand + 1, 0.1);
  recorder.finish();
}

/// An encoder that waits until it may begin, and then notes what comes.
struct SlowEncoder {
  std::promise<void> begin;
  std::vector<int> levels;
  Recorder::Encode encode() {
    return [this](const auto& next, const auto&, const auto&) {
      begin.get_future().wait();
      while (const auto picture = next()) levels.push_back(picture->pixels[0]);
    };
  }
};

TEST_F(Recording, SaysThatTheEncoderIsBehindAndLeavesNothingOut) {
  SlowEncoder slow;
  Recorder recorder(folder / "film.mp4", 30, slow.encode());
  int n = 0;
  for (; recorder.has_room(); ++n) recorder.add(plain(64, 48, static_cast<std::uint8_t>(n)), n / 30.0);
  EXPECT_NEAR(n, static_cast<int>(Recorder::most_waiting), 2);
  EXPECT_NEAR(recorder.behind(), n / 30.0, 1e-9);
  recorder.end();
  EXPECT_FALSE(recorder.is_done()) << "nobody waits for it";
  slow.begin.set_value();
  recorder.finish();
  EXPECT_TRUE(recorder.is_done());
  ASSERT_EQ(slow.levels.size(), static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) EXPECT_EQ(slow.levels[static_cast<std::size_t>(k)], k);
}

// As large as a screen: they take a quarter of a gigabyte at most.
TEST_F(Recording, KeepsFewerLargePictures) {
  SlowEncoder slow;
  Recorder recorder(folder / "film.mp4", 30, slow.encode());
  const RgbImage large = plain(3840, 2160, 7);
  int n = 0;
  for (; recorder.has_room(); ++n) recorder.add(large, n / 30.0);
  EXPECT_GE(n, 4);
  EXPECT_LE(static_cast<std::size_t>(n) * large.pixels.size(), Recorder::most_bytes);
  slow.begin.set_value();
  recorder.finish();
}

/// Films of frames whose pictures have the number of the frame as their level.
class Filming : public Recording {
 protected:
  void draw(const std::string& film, double time) {
    Frame frame;
    frame.film = film, frame.film_fps = 30;
    films.record(frame, time, [&] { return plain(64, 48, static_cast<std::uint8_t>(shown)); });
    films.poll();
  }
  std::vector<std::string> said;
  SlowEncoder slow;
  PictureFilms films{[this](const std::string& text, bool) { said.push_back(text); }, slow.encode()};
  int shown = 0;
};

// The clock of the film stands while the world waits: what it shows is as fast as ever.
TEST_F(Filming, WaitsForTheEncoderWithoutALoss) {
  const std::string file = (folder / "film.mp4").string();
  double time = 3;
  for (; !films.is_behind(); ++shown, time += 1 / 30.0) draw(file, time);
  for (int n = 0; n < 50; ++n, time += 1 / 30.0) draw(file, time);
  const int until_then = shown;
  EXPECT_NEAR(*films.seconds(), until_then / 30.0, 0.05);
  EXPECT_NEAR(films.seconds_behind(), until_then / 30.0, 0.05);
  slow.begin.set_value();
  films.wait_for_room();
  for (int n = 0; n < 10; ++n, ++shown, time += 1 / 30.0) films.wait_for_room(), draw(file, time);
  EXPECT_TRUE(said.empty());
  draw("", time);
  films.finish();
  ASSERT_NEAR(static_cast<double>(slow.levels.size()), shown, 1);
  for (int level = 0; level < shown; ++level)
    EXPECT_EQ(std::count(slow.levels.begin(), slow.levels.end(), level), 1) << level;
}

TEST_F(Filming, EndsBesideWhatGoesOn) {
  const std::string file = (folder / "film.mp4").string();
  for (; shown < 5; ++shown) draw(file, shown / 30.0);
  draw("", 1);
  EXPECT_FALSE(films.seconds());
  EXPECT_FALSE(films.are_written());
  EXPECT_TRUE(films.is_in_use(file)) << "another film takes another name";
  EXPECT_TRUE(said.empty());
  slow.begin.set_value();
  for (int n = 0; n < 500 && !films.are_written(); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    films.poll();
  }
  EXPECT_TRUE(films.are_written());
  EXPECT_EQ(slow.levels.size(), 5U);
  EXPECT_THAT(said, testing::ElementsAre("filmed " + file));
}

TEST_F(Filming, AFilmThatHasEndedIsNotBegunAnew) {
  const std::string file = (folder / "film.mp4").string();
  draw(file, 0);
  slow.begin.set_value();
  // As a window that closes does, while frames still ask for the film.
  films.end();
  draw(file, 1);
  EXPECT_FALSE(films.seconds());
  films.finish();
  EXPECT_EQ(slow.levels.size(), 1U);
}

TEST_F(Filming, SaysWhatWentWrongWhileItEnded) {
  PictureFilms own{[this](const std::string& text, bool is_error) {
                     EXPECT_TRUE(is_error);
                     said.push_back(text);
                   },
                   [](const auto& next, const auto&, const auto&) {
                     while (next()) {
                     }
                     throw RunError("the disk is full");
                   }};
  Frame frame;
  frame.film = "film.mp4";
  own.record(frame, 0, [] { return plain(64, 48, 1); });
  own.end();
  for (int n = 0; n < 500 && said.empty(); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    own.poll();
  }
  EXPECT_THAT(said, testing::ElementsAre("no film: the disk is full"));
  EXPECT_TRUE(own.are_written());
}

TEST_F(Recording, KeepsTheSizeOfTheFirstPictureMadeEven) {
  const std::filesystem::path file = folder / "film.mp4";
  {
    Recorder recorder(file, 60);
    recorder.add(plain(65, 49, 120), 0);
    recorder.add(plain(33, 101, 200), 1.0 / 60);
    recorder.add(plain(1, 1, 200), 2.0 / 60);
  }
  const Decoded film = decode(file);
  ASSERT_EQ(film.frames.size(), 3U);
  EXPECT_EQ(film.frames[0].width, 64);
  EXPECT_EQ(film.frames[0].height, 48);
  EXPECT_NEAR(film.frames[1].at(32, 24)[0], 200, 8) << "in the middle";
  EXPECT_LT(film.frames[1].at(4, 24)[0], 20) << "black around it";
}

TEST_F(Recording, SaysWhatWentWrong) {
  Recorder recorder(folder / "none" / "film.mp4", 60);
  EXPECT_THROW(
      {
        for (int n = 0; n < 100; ++n) recorder.add(plain(64, 48, 1), n / 60.0);
        recorder.finish();
      },
      std::exception);
}

TEST_F(Recording, WorksWithoutAWindow) {
  std::ofstream(folder / "script.txt") << "frames 2\nfilm " << (folder / "a.mp4").string() << "\nframes 12\nfilm off\n"
                                       << "frames 2\nfilm " << (folder / "b.mp4").string() << " 30\n";
  HeadlessOptions o;
  o.play = quiet_options(2);
  o.script = folder / "script.txt", o.frames = 10, o.width = 201, o.height = 121, o.panels = false;
  const std::uint64_t hash = play_headless(small_scene(), o);
  const Decoded a = decode(folder / "a.mp4"), b = decode(folder / "b.mp4");
  EXPECT_EQ(a.frames.size(), 12U);
  EXPECT_EQ(a.frames_a_second, 60);
  ASSERT_EQ(a.frames.at(0).width, 200);
  ASSERT_EQ(a.frames.at(0).height, 120);
  EXPECT_EQ(b.frames_a_second, 30);
  EXPECT_NEAR(static_cast<double>(b.frames.size()), 5, 1);
  std::ofstream(folder / "script.txt") << "frames 26\n";
  o.frames = 0;
  EXPECT_EQ(play_headless(small_scene(), o), hash) << "filming changes nothing";
}

TEST_F(Recording, HasBothSidesOfAComparison) {
  std::ofstream(folder / "script.txt") << "compare on honey\nfilm " << (folder / "a.mp4").string()
                                       << "\nframes 3\nfilm off\n";
  HeadlessOptions o;
  o.play = quiet_options(2);
  o.script = folder / "script.txt", o.width = 200, o.height = 120, o.panels = false;
  play_headless(small_scene(), o);
  const Decoded a = decode(folder / "a.mp4");
  ASSERT_EQ(a.frames.size(), 3U);
  EXPECT_EQ(a.frames.at(0).width, 200);
}

TEST_F(Recording, RefusesWhatItCannotWrite) {
  Playground p(small_scene(), quiet_options());
  play(p, {"refused film a.avi", "refused film /proc/a.mp4", "refused film a.mp4 25", "film off"});
  EXPECT_EQ(p.frame()->film, "");
  play(p, {"film " + (folder / "a.mp4").string()});
  EXPECT_EQ(p.frame()->film, (folder / "a.mp4").string());
  play(p, {"refused film b.mp4", "film off"});
}

// As fast as it was played, with what was kept of it, and where it says.
TEST_F(Recording, AKeySavesTheLastFiveSeconds) {
  const std::filesystem::path here = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  {
    gl::HeadlessContext context;
    App app([](const Action&) { return std::uint64_t{0}; }, 1, "test", true);
    app.show_panels(false);
    Playground p(small_scene(), quiet_options());
    Input input;
    input.inside = true, input.x = 110, input.y = 60;  // on the floor beside the tank, with a ring about it
    // Six and a half seconds of playing, and a pause that is left out. Short steps: little moves.
    play(p, {"set speed 0.25"});
    for (int n = 0; n < 420; ++n) {
      if (n == 390) play(p, {"set paused 1"});
      p.tick({});
      app.keep(p.frame());
    }
    const auto draw = [&] {
      input.time += 1.0 / 60;
      app.draw(*p.frame(), input, 160, 90, 1);
      input.pressed.clear(), input.released.clear();
    };
    draw();
    EXPECT_GT(yellow(app.picture()), 8);
    input.pressed = {'L'};
    draw();
    for (int n = 0; n < 400 && !std::filesystem::exists("tank-last-001.mp4"); ++n) draw();
  }
  std::filesystem::current_path(here);
  const Decoded film = decode(folder / "tank-last-001.mp4");
  EXPECT_EQ(film.frames_a_second, 30);
  EXPECT_NEAR(static_cast<double>(film.frames.size()), 150, 2);
  EXPECT_EQ(yellow(film.frames.at(100)), 0) << "where the pointer is now it was not then";
}

}  // namespace
}  // namespace dreampm::play::recorder_test
