// Small, medium and large.
#include <gtest/gtest.h>

#include <string>

#include "dreampm/play/model/size_chooser.h"
#include "play/small_scene.h"

namespace dreampm::play::size_test {
namespace {
using namespace test;

TEST(Size, HasFewerOrMoreParticlesOfTheSameWorld) {
  Playground p(small_scene(), quiet_options());
  const auto medium = static_cast<double>(p.frame()->particles);
  p.act(Action::parse("size small"));
  EXPECT_NEAR(static_cast<double>(p.frame()->particles) / medium, 0.4, 0.15);
  EXPECT_EQ(p.frame()->size, 0U);
  EXPECT_NE(p.frame()->message.find("small"), std::string::npos);
  p.act(Action::parse("size large"));
  EXPECT_NEAR(static_cast<double>(p.frame()->particles) / medium, 2, 0.5);
  // In whole cells.
  const Vec3d size = p.frame()->domain.size(), own = small_scene().scene.max() - small_scene().scene.min();
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(size[a], own[a], 2 * small_scene().scene.spacing());
  p.act(Action::parse("size medium"));
  EXPECT_EQ(static_cast<double>(p.frame()->particles), medium);
  EXPECT_EQ(p.frame()->spacing, small_scene().scene.spacing());
  // Undo has what was before; a story that is opened then has the size that was chosen.
  p.act(Action::parse("undo"));
  EXPECT_EQ(p.frame()->size, 2U);
  p.act(Action::parse("size small"));
  p.act(Action::parse("open jelly-stair"));
  EXPECT_EQ(p.frame()->size, 0U);
  EXPECT_NE(refusal(p, "size huge").find("small, medium, large"), std::string::npos);
}

TEST(Size, AWorldWithAGridOfItsOwnKeepsIt) {
  Playground p(load_play_scene("report"), quiet_options());
  EXPECT_FALSE(p.frame()->can_resize);
  EXPECT_NE(refusal(p, "size small").find("a grid of its own"), std::string::npos);
  Playground other(small_scene(), quiet_options());
  other.act(Action::parse("size small"));
  other.act(Action::parse("open report"));
  EXPECT_FALSE(other.frame()->can_resize) << "it is opened all the same";
}

TEST(Size, TheSameLinesGiveTheSameBits) {
  std::uint64_t hash = 0;
  for (int threads = 1; threads <= 2; ++threads) {
    Playground p(small_scene(), quiet_options(threads));
    play(p, {"steps 5", "size small", "steps 20", "push 0.06 0.06 0.12 0.06 1 0 0", "steps 10"});
    if (threads == 1) hash = p.hash();
    EXPECT_EQ(p.hash(), hash);
  }
}

/// Seconds of the clock after which a small stage is wanted where the world takes such a share of
/// real time; below 0: never in ten.
double wanted_after(SizeChooser& chooser, Frame frame, double rate) {
  for (int n = 0; n < 600; ++n) {
    frame.time += rate / 60;
    if (chooser.wants_small(frame, n / 60.0)) return n / 60.0;
  }
  return -1;
}

TEST(SizeChooser, ASecondOfMeasuringDecides) {
  Frame frame;
  frame.story = "a";
  SizeChooser slow, quick, nearly, begun, small, fixed;
  EXPECT_NEAR(wanted_after(slow, frame, 0.4), 1.3, 0.1);
  EXPECT_LT(wanted_after(slow, frame, 0.4), 0) << "once a story";
  frame.story = "b";
  EXPECT_GT(wanted_after(slow, frame, 0.4), 0);
  EXPECT_LT(wanted_after(quick, frame, 1), 0);
  EXPECT_LT(wanted_after(nearly, frame, 0.85), 0);
  frame.can_undo = true;
  EXPECT_LT(wanted_after(begun, frame, 0.4), 0) << "what a hand has begun goes on";
  frame.can_undo = false, frame.size = 0;
  EXPECT_LT(wanted_after(small, frame, 0.4), 0);
  frame.size = 1, frame.can_resize = false;
  EXPECT_LT(wanted_after(fixed, frame, 0.4), 0);
}

}  // namespace
}  // namespace dreampm::play::size_test
