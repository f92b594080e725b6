#include "dreampm/validate/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/file.h"

namespace dreampm::validate {
namespace {

constexpr double width = 720, height = 440, left = 76, right = 20, top = 40, bottom = 52;
// Okabe and Ito's colours, told apart by the colour-blind too.
constexpr std::array<const char*, 7> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#444444"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else
      out += c;
  return out;
}

/// Ticks at 1, 2 or 5 times a power of ten.
struct Axis {
  double low, high, step;

  Axis(double from, double to) : low(from), high(to) {
    if (!(high > low)) low -= 0.5 + std::abs(low) * 1e-3, high += 0.5 + std::abs(high) * 1e-3;
    const double raw = (high - low) / 6, power = std::pow(10, std::floor(std::log10(raw)));
    step = power * (raw <= power ? 1 : raw <= 2 * power ? 2 : raw <= 5 * power ? 5 : 10);
    low = std::floor(low / step + 1e-9) * step;
    high = std::ceil(high / step - 1e-9) * step;
  }
  int ticks() const { return static_cast<int>(std::lround((high - low) / step)); }
  double tick(int i) const { return low + i * step; }
  /// A tick's label; 0 must not read -1e-17.
  std::string label(int i) const {
    const double v = tick(i);
    return fmt::format("{:.6g}", std::abs(v) < 1e-9 * step ? 0 : v);
  }
};

Axis axis_of(const Plot& plot, std::vector<double> Curve::* values) {
  double low = 1e300, high = -1e300;
  for (const Curve& c : plot.curves)
    for (std::size_t i = 0; i < c.x.size(); ++i)
      if (std::isfinite(c.x[i]) && std::isfinite(c.y[i]))
        low = std::min(low, (c.*values)[i]), high = std::max(high, (c.*values)[i]);
  return low <= high ? Axis(low, high) : Axis(0, 1);
}

}  // namespace

std::string svg_of(const Plot& plot) {
  const Axis x = axis_of(plot, &Curve::x), y = axis_of(plot, &Curve::y);
  const auto at_x = [&](double v) { return left + (v - x.low) / (x.high - x.low) * (width - left - right); };
  const auto at_y = [&](double v) {
    return height - bottom - (v - y.low) / (y.high - y.low) * (height - top - bottom);
  };
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height);
  s += fmt::format("<text x=\"{}\" y=\"22\" font-size=\"15\">{}</text>\n", left, escaped(plot.title));
  for (int i = 0; i <= x.ticks(); ++i)
    s += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4}</text>\n",
        at_x(x.tick(i)), top, height - bottom, height - bottom + 17, x.label(i));
  for (int i = 0; i <= y.ticks(); ++i)
    s += fmt::format(
        "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        at_y(y.tick(i)), left, width - right, left - 6, at_y(y.tick(i)) + 4, y.label(i));
  s += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2,
                   height - 12, escaped(plot.x_axis));
  s += fmt::format("<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                   (top + height - bottom) / 2, escaped(plot.y_axis));
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    const Curve& curve = plot.curves[c];
    const char* colour = colours[c % colours.size()];
    std::string path;
    double last_x = -1e9, last_y = -1e9;  // of the line: steps of less than a pixel are left out
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
      const double px = at_x(curve.x[i]), py = at_y(curve.y[i]);
      if (curve.reference)
        s += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"none\" stroke=\"{}\"/>\n", px, py,
                         colour);
      else if (std::max(std::abs(px - last_x), std::abs(py - last_y)) >= 1 || i + 1 == curve.x.size()) {
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
        last_x = px, last_y = py;
      }
    }
    if (!path.empty())
      s += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", path, colour);
    // The legend lies over the curves, at the right.
    const double ly = top + 14 + 17 * static_cast<double>(c), lx = width - right - 200;
    if (curve.reference)
      s += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"2.6\" fill=\"none\" stroke=\"{}\"/>", lx + 10, ly - 4, colour);
    else
      s += fmt::format("<path d=\"M{} {}h20\" stroke=\"{}\" stroke-width=\"1.6\"/>", lx, ly - 4, colour);
    s += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", lx + 26, ly, escaped(curve.name));
  }
  s += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n</svg>\n", left,
                   top, width - left - right, height - top - bottom);
  return s;
}

std::filesystem::path write_plot(const Plot& plot, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / (plot.name + ".svg");
  replace_file_text(file, svg_of(plot));
  return file;
}

}  // namespace dreampm::validate
