#include "dreampm/video/letters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace dreampm {
namespace {

/// Where a picture is not black: columns from, columns to, rows from, rows to.
std::array<int, 4> drawn_in(const RgbImage& image) {
  std::array<int, 4> box{image.width, -1, image.height, -1};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (*std::max_element(image.at(x, y), image.at(x, y) + 3) > 0)
        box = {std::min(box[0], x), std::max(box[1], x), std::min(box[2], y), std::max(box[3], y)};
  return box;
}

TEST(Letters, LieInTheirPlaceAndDiffer) {
  const Letters letters;
  RgbImage one(100, 40), other(100, 40);
  letters.draw(one, 10, 5, "spacing=0.02", {255, 255, 255});
  letters.draw(other, 10, 5, "spacing=0.03", {255, 255, 255});
  const auto [left, right, top, bottom] = drawn_in(one);
  EXPECT_GE(left, 10);
  EXPECT_LT(right, 10 + 12 * letters.advance());
  EXPECT_GE(top, 5);
  EXPECT_LT(bottom, 5 + letters.line_height());
  EXPECT_NE(one.pixels, other.pixels);
  // The last letter alone is another one.
  for (int y = 0; y < one.height; ++y)
    for (int x = 0; x < 10 + 11 * letters.advance(); ++x) ASSERT_EQ(*one.at(x, y), *other.at(x, y)) << x << " " << y;
}

TEST(Letters, AreCutOffAtTheEdgeAndTakeTheColor) {
  const Letters letters;
  RgbImage image(20, 10);
  letters.draw(image, -3, -4, "\xc3\xa4 wide line", {0, 200, 0});
  EXPECT_GE(drawn_in(image)[1], 0);
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) EXPECT_EQ(image.pixels[i], 0) << "no red";
  // A character of two bytes takes the room of one.
  RgbImage two(40, 20), mark(40, 20);
  letters.draw(two, 0, 0, "\xc3\xa4x", {255, 255, 255});
  letters.draw(mark, 0, 0, "?x", {255, 255, 255});
  EXPECT_EQ(two.pixels, mark.pixels);
}

}  // namespace
}  // namespace dreampm
