// PNG pictures of 8 bits a channel.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace dreampm {

inline constexpr int widest_png = 16384;  ///< pixels a side

/// Rows from the top, three bytes (red, green, blue; sRGB) a pixel.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height * 3

  RgbImage() = default;
  RgbImage(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h * 3) {}
  std::uint8_t* at(int x, int y) { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
  const std::uint8_t* at(int x, int y) const { return pixels.data() + (static_cast<std::size_t>(y) * width + x) * 3; }
};

/// Reads any PNG as 8-bit RGB (grey and palettes expand, 16 bits round, alpha is laid over black). Throws InputError if
/// the file is missing, damaged or larger than 16384 pixels a side.
RgbImage read_png(const std::filesystem::path& file);

/// Writes through replace_file. Throws InputError if the sizes do not agree, RunError if the file cannot be written.
void write_png(const std::filesystem::path& file, const RgbImage& image);

}  // namespace dreampm
