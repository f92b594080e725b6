#include "dreampm/pipeline/compare_pictures.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/io/exr.h"
#include "dreampm/io/numbered.h"
#include "dreampm/io/png.h"
#include "dreampm/pipeline/render_stage.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr double shown_gain = 8;

/// A picture as it is shown, and its numbers.
struct Compared {
  RgbImage shown;
  std::vector<float> values;  ///< three a pixel
};

Compared read_compared(const fs::path& file) {
  if (file.extension() == ".exr") {
    const Image image = read_exr_colors(file);
    Compared out{tone_map(image), {}};
    for (const Vec3f& c : image.linear) out.values.insert(out.values.end(), {c.x, c.y, c.z});
    return out;
  }
  if (file.extension() != ".png") fail_input("{}: PNG and OpenEXR pictures (.png, .exr) are compared", file.string());
  Compared out{read_png(file), {}};
  for (const std::uint8_t v : out.shown.pixels) out.values.push_back(static_cast<float>(v) / 255);
  return out;
}

PictureDifference difference_of(const std::vector<float>& a, const std::vector<float>& b) {
  PictureDifference out;
  std::size_t other = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    bool same = true;
    for (std::size_t k = i; k < i + 3; ++k) {
      const double d = std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k]));
      out.rms += d * d, out.mean += d, out.most = std::max(out.most, d);
      same = same && d == 0;
    }
    if (!same) ++other;
  }
  const auto n = static_cast<double>(a.size());
  return {std::sqrt(out.rms / n), out.mean / n, out.most, static_cast<double>(other) / (n / 3)};
}

Comparison compare(const fs::path& a, const fs::path& b, const std::string& name, const fs::path& shown) {
  if (a.extension() != b.extension())
    fail_input("{} and {} are of two kinds; give two PNG or two OpenEXR pictures", a.string(), b.string());
  const Compared left = read_compared(a), right = read_compared(b);
  if (left.shown.width != right.shown.width || left.shown.height != right.shown.height)
    fail_input("{} has {} x {} pixels and {} has {} x {}: give two of one size", a.string(), left.shown.width,
               left.shown.height, b.string(), right.shown.width, right.shown.height);
  const RgbImage all = beside(left.shown, right.shown, shown_gain);
  make_folder(shown.parent_path());
  write_png(shown, all);
  return {name, a, b, shown, difference_of(left.values, right.values)};
}

}  // namespace

RgbImage beside(const RgbImage& a, const RgbImage& b, double gain) {
  RgbImage out(3 * a.width, a.height);
  for (int y = 0; y < a.height; ++y) {
    std::copy_n(a.at(0, y), 3 * a.width, out.at(0, y));
    std::copy_n(b.at(0, y), 3 * a.width, out.at(a.width, y));
    for (int x = 0; x < 3 * a.width; ++x) {
      const double d = gain * std::abs(int(a.at(0, y)[x]) - int(b.at(0, y)[x]));
      out.at(2 * a.width, y)[x] = static_cast<std::uint8_t>(std::min(255.0, d));
    }
  }
  return out;
}

std::vector<Comparison> compare_pictures(const fs::path& a, const fs::path& b, const fs::path& out, int first,
                                         int last) {
  for (const fs::path& each : {a, b})
    if (!fs::exists(each)) fail_input("{}: no such file or folder; give two runs or two pictures", each.string());
  if (fs::is_directory(a) != fs::is_directory(b))
    fail_input("{} and {} are a folder and a file; give two runs or two pictures", a.string(), b.string());
  const bool runs = fs::is_directory(a);
  if (!runs && (first > 0 || last > 0)) fail_input("{} is a picture; frames are chosen of two runs", a.string());
  if (!runs)
    return {compare(a, b, fmt::format("{} and {}", a.filename().string(), b.filename().string()),
                    out / fmt::format("compare_{}_{}.png", a.stem().string(), b.stem().string()))};
  const RunFolder left = open_run(a), right = open_run(b);
  std::vector<Comparison> all;
  for (const int f : left.chosen(first, last)) {
    const fs::path x = picture_file(left, f), y = picture_file(right, f);
    if (fs::exists(x) && fs::exists(y))
      all.push_back(compare(x, y, fmt::format("frame {}", f), out / numbered("compare", f, ".png")));
  }
  if (all.empty())
    fail_input("{} and {} have no picture of one frame in common; dreampm render draws them", a.string(), b.string());
  return all;
}

}  // namespace dreampm
