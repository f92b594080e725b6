#include "dreampm/video/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/math/srgb.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

// The light of each value of a picture.
std::array<float, 256> linear_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / 255));
  return table;
}

std::uint8_t to_srgb(double linear) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(srgb_from_linear(linear), 0.0, 1.0) * 255));
}

// Pixels of the source that lie under one of the target, each with its share.
struct Span {
  int first = 0;
  std::vector<double> weight;
};
std::vector<Span> spans(int from, int to) {
  std::vector<Span> out(static_cast<std::size_t>(to));
  const double step = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double begin = i * step, end = std::min<double>(from, (i + 1) * step);
    Span& s = out[static_cast<std::size_t>(i)];
    s.first = static_cast<int>(begin);
    for (int p = s.first; p < end && p < from; ++p)
      s.weight.push_back((std::min<double>(end, p + 1) - std::max<double>(begin, p)) / step);
  }
  return out;
}

/// tile_width, or as much less as keeps the sheet within what a PNG holds.
int widest_tile(const RgbImage& picture, int columns, int rows, const ContactSheetSettings& s) {
  const auto side = [&](int tiles) { return (widest_png - s.gap) / tiles - s.gap; };
  const double by_height = double(side(rows)) * picture.width / picture.height;
  return std::max(1, std::min({s.tile_width, side(columns), static_cast<int>(by_height)}));
}

}  // namespace

std::vector<std::size_t> spread_evenly(std::size_t total, std::size_t count) {
  count = std::min(count, total);
  std::vector<std::size_t> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = count > 1 ? (i * (total - 1) + (count - 1) / 2) / (count - 1) : 0;
  return out;
}

RgbImage shrink(const RgbImage& image, int width) {
  if (width < 1) fail_input("a picture cannot be {} pixels wide", width);
  if (width >= image.width) return image;
  const int height = std::max(1, static_cast<int>(std::lround(double(image.height) * width / image.width)));
  const std::array<float, 256> linear = linear_table();
  const std::vector<Span> across = spans(image.width, width), down = spans(image.height, height);
  RgbImage out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Span &sx = across[static_cast<std::size_t>(x)], &sy = down[static_cast<std::size_t>(y)];
      double sum[3] = {};
      for (std::size_t j = 0; j < sy.weight.size(); ++j)
        for (std::size_t i = 0; i < sx.weight.size(); ++i) {
          const std::uint8_t* p = image.at(sx.first + static_cast<int>(i), sy.first + static_cast<int>(j));
          for (int c = 0; c < 3; ++c) sum[c] += sx.weight[i] * sy.weight[j] * static_cast<double>(linear[p[c]]);
        }
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = to_srgb(sum[c]);
    }
  return out;
}

void write_contact_sheet(const std::vector<fs::path>& pictures, const fs::path& file,
                         const ContactSheetSettings& settings) {
  if (pictures.empty()) fail_input("{}: no pictures to show", file.string());
  if (settings.count < 1 || settings.columns < 1 || settings.tile_width < 1 || settings.gap < 0)
    fail_input("{}: {} frames in {} columns of {} pixels with gaps of {}: at least 1, 1, 1 and 0", file.string(),
               settings.count, settings.columns, settings.tile_width, settings.gap);
  const std::vector<std::size_t> chosen = spread_evenly(pictures.size(), static_cast<std::size_t>(settings.count));
  const int count = static_cast<int>(chosen.size()), columns = std::min(settings.columns, count);
  const int rows = (count + columns - 1) / columns, gap = settings.gap;
  RgbImage sheet;
  int width = 0, height = 0, tile_width = 0, tile_height = 0;
  for (int i = 0; i < count; ++i) {
    const fs::path& from = pictures[chosen[static_cast<std::size_t>(i)]];
    const RgbImage picture = read_png(from);
    const RgbImage tile = shrink(picture, widest_tile(picture, columns, rows, settings));
    if (i == 0) {
      width = picture.width;
      height = picture.height;
      tile_width = tile.width;
      tile_height = tile.height;
      sheet = RgbImage(gap + columns * (tile_width + gap), gap + rows * (tile_height + gap));
      std::fill(sheet.pixels.begin(), sheet.pixels.end(), std::uint8_t(24));
    }
    if (picture.width != width || picture.height != height)
      fail_input("{}: {} x {} pixels, but {} has {} x {}", from.string(), picture.width, picture.height,
                 pictures[chosen.front()].string(), width, height);
    const int left = gap + (i % columns) * (tile_width + gap), top = gap + (i / columns) * (tile_height + gap);
    for (int y = 0; y < tile_height; ++y) std::copy_n(tile.at(0, y), tile_width * 3, sheet.at(left, top + y));
  }
  write_png(file, sheet);
}

}  // namespace dreampm
