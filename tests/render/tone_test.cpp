#include "dreampm/render/tone.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "shapes.h"

namespace dreampm {
namespace {

TEST(Tone, GraysStayGreyRiseAndReachWhite) {
  float last = -1;
  for (float x = 0; x < 20; x = 1.15f * x + 0.002f) {
    const Vec3f c = trace::develop({x, x, x});
    EXPECT_NEAR(c.x, c.z, 1e-4f);
    EXPECT_GE(c.x, last);
    EXPECT_LE(c.x, 1.0001f);
    last = c.x;
  }
  EXPECT_GT(last, 0.97f);
}

TEST(Tone, AHighlightBleedsIntoItsNeighborsOnly) {
  Image image{180, 90, std::vector<Vec3f>(180 * 90, Vec3f{0.1f, 0.1f, 0.1f})};
  const RgbImage before = tone_map(image);
  image.linear[45 * 180 + 90] = {50, 50, 50};
  const RgbImage after = tone_map(image);
  EXPECT_GT(after.at(92, 45)[1], before.at(92, 45)[1] + 5);
  EXPECT_EQ(after.at(20, 45)[1], before.at(20, 45)[1]);
}

TEST(Png, HoldsWhatToneMapGives) {
  const TriMesh ball = ball_mesh({}, 1, 12);
  const auto scene = before_uniform_sky({&ball, model::Look::opaque(srgb_of({0.9f, 0.2f, 0.1f}), 1)}, 40);
  const Image image = render(scene, small_picture(20, 12, 2));
  const auto path = std::filesystem::path(testing::TempDir()) / "render-tone-test.png";
  write_png(path, image);
  const RgbImage back = read_png(path);
  EXPECT_EQ(back.width, 20);
  EXPECT_EQ(back.height, 12);
  EXPECT_EQ(back.pixels, tone_map(image).pixels);
  EXPECT_GT(back.at(10, 6)[0], 2 * back.at(10, 6)[2]) << "the red ball in the middle";
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace dreampm
