// A context and a renderer for tests that draw.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/error.h"
#include "dreampm/gl/headless.h"
#include "dreampm/gl/renderer.h"

namespace dreampm::gl::test {

/// Needs OpenGL without a window: packages libegl-dev and libgl1-mesa-dri (tools/packages.txt).
class Drawing : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    try {
      context_ = std::make_unique<HeadlessContext>();
    } catch (const RunError& e) {
      missing_ = e.what();
      return;
    }
    renderer_ = std::make_unique<Renderer>();
  }
  static void TearDownTestSuite() {
    renderer_.reset();
    context_.reset();
  }
  void SetUp() override { ASSERT_TRUE(context_) << missing_; }

  static RgbImage drawn(const Picture& picture, const Camera& camera, int width = 256, int height = 256) {
    const Framebuffer framebuffer(width, height);
    renderer_->draw(picture, camera, framebuffer);
    return framebuffer.read();
  }
  static Renderer& renderer() { return *renderer_; }

 private:
  static inline std::unique_ptr<HeadlessContext> context_;
  static inline std::unique_ptr<Renderer> renderer_;
  static inline std::string missing_;
};

/// Nothing but background, and a camera that looks at the origin from 2 m along -z.
inline Picture empty_picture() {
  Picture picture;
  picture.floor.shown = false;
  picture.outline = false;
  picture.domain = {{-1, -1, -1}, {1, 1, 1}};
  picture.floor.height = -1;
  picture.lights = lights_for(picture.domain);
  return picture;
}
inline Camera front_camera() { return {{0, 0, 2}, {0, 0, 0}}; }

inline std::array<int, 3> pixel(const RgbImage& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return {p[0], p[1], p[2]};
}
/// Of all pixels whose coordinates are from `low` up to `high`.
inline std::array<int, 3> mean(const RgbImage& image, int low, int high) {
  std::array<int, 3> sum{};
  for (int y = low; y < high; ++y)
    for (int x = low; x < high; ++x)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += image.at(x, y)[k];
  for (int& s : sum) s /= (high - low) * (high - low);
  return sum;
}
inline int brightness(const RgbImage& image, int x, int y) {
  const auto [r, g, b] = pixel(image, x, y);
  return r + g + b;
}
/// How many pixels differ by more than 8 of 255 in a channel.
inline int changed_pixels(const RgbImage& a, const RgbImage& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const auto p = pixel(a, x, y), q = pixel(b, x, y);
      count += std::abs(p[0] - q[0]) > 8 || std::abs(p[1] - q[1]) > 8 || std::abs(p[2] - q[2]) > 8;
    }
  return count;
}

/// Places on a lattice that fills a box.
inline std::vector<Vec3f> filled(const Box3f& box, float spacing) {
  std::vector<Vec3f> points;
  for (float x = box.min.x + 0.5f * spacing; x < box.max.x; x += spacing)
    for (float y = box.min.y + 0.5f * spacing; y < box.max.y; y += spacing)
      for (float z = box.min.z + 0.5f * spacing; z < box.max.z; z += spacing) points.push_back({x, y, z});
  return points;
}

}  // namespace dreampm::gl::test
