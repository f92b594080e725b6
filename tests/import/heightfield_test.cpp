// Height fields: pictures as ground.
#include "dreampm/import/heightfield.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/level_set/level_set.h"
#include "thrown.h"

namespace dreampm::heightfield_test {
namespace {
using testing::HasSubstr;

class Heightfield : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  /// A ramp from black on the left to white on the right.
  std::string ramp(int width, int height) const {
    std::vector<std::uint8_t> pixels;
    for (int n = 0; n < width * height; ++n)
      pixels.push_back(static_cast<std::uint8_t>(255 * (n % width) / (width - 1)));
    png_image picture{};
    picture.version = PNG_IMAGE_VERSION, picture.format = PNG_FORMAT_GRAY;
    picture.width = static_cast<png_uint_32>(width), picture.height = static_cast<png_uint_32>(height);
    const std::string file = (folder / "ramp.png").string();
    EXPECT_TRUE(png_image_write_to_file(&picture, file.c_str(), 0, pixels.data(), 0, nullptr));
    return file;
  }
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("dreampm_heights_" + std::to_string(::getpid()));
};

const Box3d box{{0, 0.1, 0}, {1, 0.6, 2}};

TEST_F(Heightfield, IsAClosedGround) {
  const Model model = heightfield_model(ramp(52, 7), box);
  EXPECT_EQ(model.vertices.size(), 52u * 7 + 2 * (52 + 7) - 4 + 1);
  // A wedge of half the box on a slab as high as the box.
  EXPECT_NEAR(enclosed_volume(model), 1 * 2 * (0.5 * 0.5 + 0.5), 1e-9);
}

TEST_F(Heightfield, IsAsFarAsItsSurface) {
  MeshShape shape;
  shape.path = ramp(52, 7), shape.heights = box;
  const auto region = mesh_regions()(shape, 0.02, 0.1);
  const Vec3d normal = normalized(Vec3d{-0.5, 1, 0});
  for (const double x : {0.3, 0.5, 0.71})
    for (const double off : {-0.03, -0.01, 0.02, 0.05}) {
      const Vec3d p = Vec3d{x, 0.1 + 0.5 * x, 1.1} + normal * off;
      EXPECT_NEAR(region->distance(p), off, 0.002) << x;
      EXPECT_GT(dot(region->normal(p), normal), 0.999);
    }
}

TEST_F(Heightfield, WhatIsNoPictureIsRefused) {
  const auto refused = [&](const std::string& file) { return test::refusal([&] { heightfield_model(file, box); }); };
  EXPECT_THAT(refused((folder / "no.png").string()), HasSubstr("no.png"));
  write_bytes(folder / "text.png", "heights", 7);
  EXPECT_THAT(refused((folder / "text.png").string()), HasSubstr("text.png: a height field must be a PNG picture"));
  const std::string whole = read_file(ramp(52, 7));
  write_bytes(folder / "cut.png", whole.data(), whole.size() / 2);
  EXPECT_THAT(refused((folder / "cut.png").string()), HasSubstr("cut.png: a damaged PNG picture: it is cut short"));
  EXPECT_THAT(refused(ramp(3000, 2)), HasSubstr("3000 x 2 pixels; a height field has 2 to 2048 a side"));
}

}  // namespace
}  // namespace dreampm::heightfield_test
