// Pictures of 8 bits a channel.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace dreampm {

/// Rows from the top, three bytes (red, green, blue; sRGB) a pixel.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height * 3

  RgbImage() = default;
  RgbImage(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h * 3) {}
  std::uint8_t* at(int x, int y) { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
  const std::uint8_t* at(int x, int y) const { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
};

/// Writes a PNG, whole or not at all. Throws InputError if the sizes do not agree, RunError if the
/// file cannot be written.
void write_png(const std::filesystem::path& file, const RgbImage& image);

}  // namespace dreampm
