// A build without Dear ImGui has no letters.
#include <gtest/gtest.h>

#include <vector>

#include "dreampm/video/letters.h"

namespace dreampm {
namespace {

TEST(Letters, TakeNoRoomAndDrawNothingWithoutAFont) {
  const Letters letters;
  EXPECT_FALSE(Letters::there());
  EXPECT_EQ(letters.line_height(), 0);
  RgbImage image(20, 10);
  const std::vector<std::uint8_t> before = image.pixels;
  letters.draw(image, 0, 0, "spacing=0.02", {255, 255, 255});
  EXPECT_EQ(image.pixels, before);
}

}  // namespace
}  // namespace dreampm
