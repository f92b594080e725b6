// What pictures and films of the view show beside the matter.
#include <gtest/gtest.h>

#include "play/app_fixture.h"

namespace dreampm::play::saved_pictures_test {
namespace {
using namespace test;

RgbImage part_of(const RgbImage& image, int x, int y, int width, int height) {
  RgbImage part(width, height);
  for (int row = 0; row < height; ++row) std::copy_n(image.at(x, y + row), 3 * width, part.at(0, row));
  return part;
}

class SavedPictures : public AppFixture {
 protected:
  void SetUp() override {
    AppFixture::SetUp();
    window_width = 1000, window_height = 700;
  }
  /// The whole window, and the picture that is saved of it.
  void look() {
    draw(3);
    window = picture(), saved = app->view();
  }
  RgbImage window, saved;
};

TEST_F(SavedPictures, HaveTheLegendAndTheScaleButNoPanels) {
  constexpr int wide = 140, high = 50, margin = 12;  // hints lie over its left
  const auto legend_of = [&](const RgbImage& image, int right) {
    return part_of(image, right - margin - wide, saved.height - margin - high, wide, high);
  };
  look();
  const RgbImage before = legend_of(saved, saved.width);
  playground->act(Action::parse("set color_by 1"));
  look();
  const RgbImage legend = legend_of(saved, saved.width);
  EXPECT_GT(differing(before, legend), wide * high) << "colors of speeds";
  EXPECT_EQ(differing(legend, legend_of(window, window.width)), 0);
  // The meters lie at the upper right.
  const auto corner = [&](const RgbImage& image) { return part_of(image, image.width - 200, 20, 180, 80); };
  EXPECT_GT(differing(corner(saved), corner(window)), 1000);

  const auto scale_of = [&](const RgbImage& image) { return part_of(image, 10, saved.height - 40, 120, 36); };
  const RgbImage with = scale_of(saved);
  playground->act(Action::parse("set scale_bar 0"));
  look();
  EXPECT_GT(differing(with, scale_of(saved)), 300);
}

}  // namespace
}  // namespace dreampm::play::saved_pictures_test
