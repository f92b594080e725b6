// Pictures for the tests of films and sheets.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/io/png.h"
#include "thrown.h"

namespace dreampm::test {

/// A folder of its own for the running test, empty at first.
inline std::filesystem::path fresh_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder =
      std::filesystem::path(DM_BINARY_DIR) / "test-files" / (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

/// A plain picture of one color.
inline RgbImage plain(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  RgbImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = r;
      image.at(x, y)[1] = g;
      image.at(x, y)[2] = b;
    }
  return image;
}

inline std::filesystem::path numbered(const std::filesystem::path& folder, int n) {
  return folder / fmt::format("render_{:06d}.png", n);
}

}  // namespace dreampm::test
