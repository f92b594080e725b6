// What leaves by open walls, the dragon that falls, and pressure as it is shown.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "dreampm/play/window/headless.h"
#include "play/small_scene.h"

namespace dreampm::play::matter_leaves_test {
namespace {
using namespace test;
using testing::HasSubstr;

/// A block of water on the floor of a box without a lid.
PlayScene without_lid(double depth = 0.1) {
  return {"cup", parse_scene("dreampm: 1\nname: cup\nspace: {min: [0, 0, 0], max: [0.16, 0.4, 0.16], spacing: 0.01, "
                             "walls: {y_max: {type: open}}}\ntime: {fps: 60}\nmaterials:\n  water: {type: newtonian, "
                             "preset: water, max_compression: 0.03}\nbodies:\n  block: {material: water, shape: {box: "
                             "{min: [0, 0, 0], max: [0.16, " +
                                 text_of(depth) + ", 0.16]}}}\n",
                             "cup.yaml")};
}

TEST(MatterThatLeaves, IsSaidWithTheWallAndComesBackByUndo) {
  Playground p(without_lid(), quiet_options());
  const std::size_t all = p.simulation().particle_count();
  play(p, {"frames 5", "set gravity.y 10", "done", "frames 55"});
  EXPECT_LT(p.simulation().particle_count(), all / 2);
  EXPECT_THAT(p.frame()->message, HasSubstr("particles left by the top: Undo"));
  EXPECT_EQ(p.frame()->lost, grouped(all - p.simulation().particle_count()) + " particles left by the top");
  play(p, {"undo"});
  EXPECT_EQ(p.simulation().particle_count(), all);
  EXPECT_EQ(value_of(p, "gravity.y"), -9.81);
  play(p, {"frames 30"});
  EXPECT_EQ(p.simulation().particle_count(), all) << "they stay";
}

// One message counts on, whenever a picture of it is made.
TEST(MatterThatLeaves, IsCountedByItsMessageToTheLast) {
  Playground p(without_lid(), quiet_options());
  const std::size_t all = p.simulation().particle_count();
  play(p, {"frames 5", "set gravity.y 10", "done"});
  std::uint64_t number = 0;
  int pictures = 0;
  for (int n = 0; n < 60; ++n) {
    play(p, {"frames 1"});
    const std::shared_ptr<const Frame> frame = p.frame();
    const std::size_t gone = all - p.simulation().particle_count();
    if (gone == 0) continue;
    EXPECT_EQ(frame->message, fmt::format("{} particle{} left by the top: Undo", grouped(gone), gone == 1 ? "" : "s"));
    if (number == 0) number = frame->message_number;
    EXPECT_EQ(frame->message_number, number);
    ++pictures;
  }
  EXPECT_GT(pictures, 5);
}

TEST(MatterThatLeaves, ByAPushIsBackAfterUndo) {
  Playground p(without_lid(), quiet_options());
  const std::size_t all = p.simulation().particle_count();
  play(p, {"frames 5", "set strength 10", "push 0.08 0.05 0.08 0.2 0 5 0", "frames 12", "release", "frames 40"});
  EXPECT_LT(p.simulation().particle_count(), all);
  EXPECT_THAT(p.frame()->message, HasSubstr("left by the top: Undo"));
  play(p, {"undo", "frames 30"});
  EXPECT_EQ(p.simulation().particle_count(), all);
}

TEST(MatterThatLeaves, IsNotWhatIsErased) {
  Playground p(without_lid(), quiet_options());
  play(p, {"frames 5", "erase 0.08 0.05 0.08 0.06", "frames 10"});
  EXPECT_EQ(p.frame()->lost, "");
  EXPECT_EQ(p.frame()->message, "");
}

// A gap that parts matter is as wide as what holds it together reaches: what lay there is gone, and
// that is said.
TEST(MatterThatLeaves, ByACutIsSaidAndComesBackByUndo) {
  Playground p(without_lid(), quiet_options());
  const std::size_t all = p.simulation().particle_count();
  play(p, {"frames 2", "cut 0.08 0.05 0.08 1 0 0 0.4"});
  const std::size_t gone = all - p.simulation().particle_count();
  EXPECT_NEAR(static_cast<double>(gone), static_cast<double>(all) / 8, 0.05 * static_cast<double>(all));
  EXPECT_EQ(p.frame()->message,
            fmt::format("cut: {} particles taken out for a gap, {:.2g} % of all: Undo", grouped(gone),
                        100.0 * static_cast<double>(gone) / static_cast<double>(all)));
  play(p, {"undo"});
  EXPECT_EQ(p.simulation().particle_count(), all);
  play(p, {"cut 0.08 0.3 0.08 0 1 0 0.4"});
  EXPECT_EQ(p.frame()->message, "cut: no matter was in its way");
  EXPECT_EQ(p.simulation().particle_count(), all);
}

// In a folder without the fetched model.
TEST(Dragon, FallsWithoutADownloadAndSaysWhichOne) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("no-models-" + std::to_string(::getpid()));
  ::setenv("DREAMPM_CACHE", folder.c_str(), 1);
  Playground p(small_scene(), quiet_options());
  const std::size_t before = p.simulation().particle_count();
  play(p, {"set matter 3", "drop dragon 0.2 0.25 0.12 0.36", "frames 3"});
  // Of a cube of that length it fills a twenty-seventh; what is thin has fewer particles.
  constexpr double cube = 18 * 18 * 18;
  EXPECT_NEAR(static_cast<double>(p.simulation().particle_count() - before), 0.037 * cube, 0.3 * 0.037 * cube);
  EXPECT_THAT(p.frame()->message, HasSubstr("little dragon"));
  EXPECT_THAT(p.frame()->message, HasSubstr("tools/fetch_dragon"));
  ::unsetenv("DREAMPM_CACHE");
}

TEST(Dragon, AFileThatCannotBeReadLeavesNoMaterialBehind) {
  Playground p(small_scene(), quiet_options());
  const std::size_t before = p.frame()->matter.size();
  EXPECT_THAT(refusal(p, "set matter 6"), "");
  EXPECT_THAT(refusal(p, "drop none.obj 0.2 0.25 0.12 0.2"), HasSubstr("none.obj"));
  EXPECT_EQ(p.frame()->matter.size(), before);
}

/// Of what is shown with depth.
double correlation_with_depth(const std::vector<Vec3f>& position, const std::vector<float>& value) {
  const auto n = static_cast<double>(position.size());
  double depth = 0, mean = 0, both = 0, depth2 = 0, value2 = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    depth -= static_cast<double>(position[i].y) / n, mean += static_cast<double>(value[i]) / n;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double d = -static_cast<double>(position[i].y) - depth, v = static_cast<double>(value[i]) - mean;
    both += d * v, depth2 += d * d, value2 += v * v;
  }
  return both / std::sqrt(depth2 * value2);
}

// In a column that rings up and down as it takes its weight up: in the mean over a fifth of a
// second, by the factor of the hydrostatic law.
TEST(ColorByPressure, GrowsWithDepth) {
  Playground p(without_lid(0.3), quiet_options());
  play(p, {"set color_by 2", "frames 60"});
  double low = 0, high = 0;
  int at_low = 0, at_high = 0;
  for (int k = 0; k < 12; ++k) {
    play(p, {"frames 1"});
    const std::shared_ptr<const Frame> frame = p.frame();
    ASSERT_EQ(frame->value_label, "pressure");
    const MatterFrame& water = frame->matter[0];
    EXPECT_GT(correlation_with_depth(water.position, water.value), 0.9);
    for (std::size_t i = 0; i < water.position.size(); ++i) {
      if (const float y = water.position[i].y; y > 0.05f && y < 0.09f)
        low += static_cast<double>(water.value[i]), ++at_low;
      else if (y > 0.21f && y < 0.25f)
        high += static_cast<double>(water.value[i]), ++at_high;
    }
  }
  ASSERT_GT(std::min(at_low, at_high), 600);
  EXPECT_NEAR(low / at_low - high / at_high, 998.2 * 9.81 * 0.16, 0.15 * 998.2 * 9.81 * 0.16);
}

}  // namespace
}  // namespace dreampm::play::matter_leaves_test
