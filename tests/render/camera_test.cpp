#include "dreampm/render/camera.h"

#include <gtest/gtest.h>

namespace dreampm {
namespace {

TEST(Camera, TheBasinFillsTheAskedShareOfTheFrame) {
  const Box3f basin{{0, 0, 0}, {1, 1.2f, 0.6f}};
  for (const double fill : {0.5, 0.84})
    for (const auto& [width, height] : {std::pair{640, 360}, std::pair{300, 600}}) {
      model::Camera wish;
      wish.fill = fill;
      const trace::Camera camera(wish, basin, width, height);
      float x0 = 1e9f, x1 = -1e9f, y0 = 1e9f, y1 = -1e9f;
      for (int k = 0; k < 8; ++k) {
        const auto [x, y] = camera.project({(k & 1) ? 1.0f : 0.0f, (k & 2) ? 1.2f : 0.0f, (k & 4) ? 0.6f : 0.0f});
        x0 = std::min(x0, x / static_cast<float>(width)), x1 = std::max(x1, x / static_cast<float>(width));
        y0 = std::min(y0, y / static_cast<float>(height)), y1 = std::max(y1, y / static_cast<float>(height));
      }
      EXPECT_NEAR(std::max(x1 - x0, y1 - y0), fill, 0.01);
      EXPECT_NEAR(x0 + x1, 1, 0.02f);
      EXPECT_NEAR(y0 + y1, 1, 0.02f);
    }
}

TEST(Camera, ADirectionAndItsProjectionAgree) {
  model::Camera wish;
  wish.fit_basin = false;
  wish.from = {1, 2, 3}, wish.to = {0, 0.5, 0};
  const trace::Camera camera(wish, {}, 400, 300);
  const auto [x, y] = camera.project(camera.eye() + camera.direction(37, 211) * 2.5f);
  EXPECT_NEAR(x, 37, 0.01f);
  EXPECT_NEAR(y, 211, 0.01f);
}

}  // namespace
}  // namespace dreampm
