// When the window draws.
#include "dreampm/play/window/pace.h"

#include <gtest/gtest.h>

#include <memory>

namespace dreampm::play::pace_test {
namespace {

/// Pictures in ten seconds of a loop that looks 200 times a second.
int pictures(PicturePace& pace, Frame frame, bool moves, bool touched = false, double from = 0) {
  int count = 0;
  for (int n = 0; n < 2000; ++n) {
    const double now = from + n / 200.0;
    if (moves && n % 4 == 0) ++frame.number, frame.time += 0.01, frame.steps += 10;
    if (!pace.is_due(frame, now, touched, 0)) continue;
    pace.drew(frame, now);
    ++count;
  }
  return count;
}

TEST(PicturePace, PicturesLeaveTheProcessorToASolverThatDoesNotKeepUp) {
  Frame frame;
  frame.meters.rate = 1;
  PicturePace kept;
  EXPECT_EQ(pictures(kept, frame, true), 2000) << "as fast as the screen";
  frame.meters.rate = 0.5;
  PicturePace slow;
  EXPECT_LE(pictures(slow, frame, true), 340);
  EXPECT_GE(pictures(slow, frame, true, false, 10), 280);
  frame.meters.rate = 1;
  EXPECT_GT(pictures(slow, frame, true, false, 20), 1000) << "and it keeps up again";
}

TEST(PicturePace, WhatStandsStillIsNotDrawnAnew) {
  Frame frame;
  frame.settings.paused = 1;
  PicturePace pace;
  pictures(pace, frame, false);
  EXPECT_EQ(pictures(pace, frame, false, false, 10), 0);
  // What a hand does is shown, and what panels show late.
  EXPECT_TRUE(pace.is_due(frame, 30, true, 0));
  pace.drew(frame, 30);
  EXPECT_TRUE(pace.is_due(frame, 30.5, false, 0));
  EXPECT_FALSE(pace.is_due(frame, 32, false, 0));
  EXPECT_TRUE(pace.is_due(frame, 32, false, 33)) << "a hint fades";
  // So is what the solver did.
  frame.actions = 1;
  EXPECT_TRUE(pace.is_due(frame, 40, false, 0));
  pace.drew(frame, 40);
  EXPECT_FALSE(pace.is_due(frame, 41, false, 0));
  frame.film = "a.mp4";
  EXPECT_TRUE(pace.is_due(frame, 41, false, 0)) << "a film goes on";
  frame.film.clear();
  RenderStatus film;
  film.state = RenderStatus::State::running;
  frame.rendering = std::make_shared<const RenderStatus>(film);
  const int seen = pictures(pace, frame, false, false, 50);
  EXPECT_GE(seen, 30) << "the progress of what is rendered";
  EXPECT_LE(seen, 45);
}

}  // namespace
}  // namespace dreampm::play::pace_test
