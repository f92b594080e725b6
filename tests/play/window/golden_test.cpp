// Pictures of early frames against those kept in golden/, in blocks: another driver's edges pass,
// and a missing object, another color or a picture upside down does not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "dreampm/base/file.h"
#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/image.h"
#include "dreampm/io/png.h"
#include "dreampm/play/window/headless.h"
#include "play/small_scene.h"

namespace dreampm::play::golden_test {
namespace {
using namespace test;

constexpr int width = 320, height = 180, block = 16;
/// Levels of 256: of a block on average and at worst, over the channels. Another driver stays far
/// below; what is wrong lies far above.
constexpr double most_mean = 2, most_worst = 14;

struct Difference {
  double mean = 0, worst = 0;
  bool passes() const { return mean <= most_mean && worst <= most_worst; }
};

/// Between the mean colors of blocks.
Difference difference(const RgbImage& a, const RgbImage& b) {
  Difference d;
  int count = 0;
  for (int top = 0; top < height; top += block)
    for (int left = 0; left < width; left += block, ++count) {
      double off = 0;
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        int pixels = 0;
        for (int y = top; y < std::min(top + block, height); ++y)
          for (int x = left; x < std::min(left + block, width); ++x, ++pixels) sum += a.at(x, y)[c] - b.at(x, y)[c];
        off += std::abs(sum) / pixels / 3;
      }
      d.mean += off, d.worst = std::max(d.worst, off);
    }
  d.mean /= count;
  return d;
}

struct Golden {
  const char *name, *stage;
  std::size_t preset;
  int frames;
};

void PrintTo(const Golden& g, std::ostream* out) { *out << g.name; }

class GoldenPicture : public testing::TestWithParam<Golden> {};

TEST_P(GoldenPicture, IsAsItWas) {
  const Golden& g = GetParam();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "play-golden" / g.name;
  HeadlessOptions o;
  o.play = quiet_options(2);
  o.frames = g.frames, o.every = g.frames, o.width = width, o.height = height, o.panels = false;
  o.screenshots = folder;
  // Letters differ from machine to machine.
  std::filesystem::create_directories(folder);
  o.script = folder / "script.txt";
  replace_file_text(o.script, "set scale_bar 0\n");
  play_headless(load_play_scene(g.stage, g.preset), o);
  const RgbImage now = read_png(folder / fmt::format("frame-{:04}.png", g.frames));
  ASSERT_EQ(now.width, width);
  ASSERT_EQ(now.height, height);
  const std::filesystem::path file =
      std::filesystem::path(DM_SOURCE_DIR) / "tests" / "play" / "golden" / fmt::format("{}.png", g.name);
  const RgbImage kept = read_png(file);
  const Difference d = difference(now, kept);
  EXPECT_TRUE(d.passes()) << (folder / "").string() << " and " << file << ": " << d.mean << " levels off, at worst "
                          << d.worst;
  // The comparison sees what is wrong.
  RgbImage flipped(width, height), mirrored(width, height), blank(width, height), swapped(width, height), empty = kept;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        flipped.at(x, y)[c] = kept.at(x, height - 1 - y)[c];
        mirrored.at(x, y)[c] = kept.at(width - 1 - x, y)[c];
        blank.at(x, y)[c] = kept.at(0, 0)[c];
        swapped.at(x, y)[c] = kept.at(x, y)[2 - c];
      }
  // Matter is what has a color; without it floor is seen.
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (const auto [low, high] = std::minmax_element(kept.at(x, y), kept.at(x, y) + 3); *high - *low > 50)
        std::fill_n(empty.at(x, y), 3, std::uint8_t{190});
  for (const RgbImage* wrong : {&flipped, &mirrored, &blank, &swapped, &empty}) {
    const Difference w = difference(*wrong, kept);
    EXPECT_GT(w.worst, 1.5 * most_worst) << (wrong == &flipped    ? "upside down"
                                             : wrong == &mirrored ? "mirrored"
                                             : wrong == &blank    ? "blank"
                                             : wrong == &swapped  ? "red for blue"
                                                                  : "without its matter");
  }
}

INSTANTIATE_TEST_SUITE_P(Play, GoldenPicture,
                         testing::Values(Golden{"dam-break", "dam-break", 0, 6}, Golden{"report", "report", 1, 12},
                                         Golden{"honey", "honey-coil", 0, 20}),
                         [](const auto& named) {
                           std::string name = named.param.name;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace dreampm::play::golden_test
