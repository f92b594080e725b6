#include "validate/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/file.h"

namespace dreampm::validate {
namespace {

constexpr double width = 720, height = 440, left = 76, right = 20, top = 40, bottom = 52;
// Okabe and Ito's colors, distinguishable for the color-blind too.
constexpr std::array<const char*, 7> colors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
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

/// An axis: the range that is drawn, with a little room around it, and ticks in it at 1, 2 or 5
/// times a power of ten.
struct Axis {
  double low, high, step, first;  ///< first: a tick

  Axis(double from, double to) : low(from), high(to) {
    if (!(high > low)) low -= 0.5 + std::abs(low) * 1e-3, high += 0.5 + std::abs(high) * 1e-3;
    const double room = 0.03 * (high - low);
    low -= room, high += room;
    const double raw = (high - low) / 7, power = std::pow(10, std::floor(std::log10(raw)));
    step = power * (raw <= power ? 1 : raw <= 2 * power ? 2 : raw <= 5 * power ? 5 : 10);
    first = std::ceil(low / step) * step;
  }
  int ticks() const { return static_cast<int>(std::floor((high - first) / step)) + 1; }
  double tick(int i) const { return first + i * step; }
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

struct Pixel {
  double x, y;
};

/// A curve's finite points on the page.
std::vector<Pixel> pixels_of(const Curve& curve, const Axis& x, const Axis& y) {
  std::vector<Pixel> points;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]))
      points.push_back({left + (curve.x[i] - x.low) / (x.high - x.low) * (width - left - right),
                        height - bottom - (curve.y[i] - y.low) / (y.high - y.low) * (height - top - bottom)});
  return points;
}

/// The pen with which a curve is drawn.
struct Pen {
  const char* color;
  const char* line = "stroke-width=\"1.6\"";  ///< attributes
};

// Distinguished by their grays and their dashes.
constexpr std::array<Pen, 3> dashed{{{"#888888", "stroke-width=\"1.2\" stroke-dasharray=\"8 4\""},
                                     {"#222222", "stroke-width=\"1.4\" stroke-dasharray=\"2 3\""},
                                     {"#555555", "stroke-width=\"1.2\" stroke-dasharray=\"10 3 2 3\""}}};

/// The pen of each curve; bounds have some of their own. The references wear the colors of the
/// lines they belong to where there are as many of both: the first that of the first, and so on.
std::vector<Pen> pens_of(const Plot& plot) {
  std::size_t references = 0;
  std::size_t bounds = 0;
  for (const Curve& c : plot.curves) references += c.reference, bounds += c.bound;
  const bool paired = 2 * references + bounds == plot.curves.size();
  std::vector<Pen> out;
  std::size_t next[2] = {0, 0}, next_bound = 0;
  for (const Curve& c : plot.curves)
    if (c.bound)
      out.push_back(dashed[next_bound++ % dashed.size()]);
    else
      out.push_back({colors[next[paired && c.reference]++ % colors.size()]});
  return out;
}

struct Legend {
  double x, y, wide, high;
  int hidden = 0;  ///< pieces of curves behind it
};

/// Returns the place of the legend where it hides least of the curves: corners first.
Legend legend_of(const Plot& plot, const std::vector<std::vector<Pixel>>& curves) {
  std::size_t longest = 0, named = 0;
  for (const Curve& c : plot.curves) longest = std::max(longest, c.name.size()), named += !c.name.empty();
  const double wide = 40 + 6.6 * static_cast<double>(longest), high = 10 + 17 * static_cast<double>(named);
  const double gap = 8, far_x = width - right - gap - wide, far_y = height - bottom - gap - high;
  const double middle = (left + width - right - wide) / 2;
  const double half = (top + height - bottom - high) / 2;
  Legend best{};
  best.hidden = -1;
  for (Legend l :
       {Legend{far_x, top + gap, wide, high}, Legend{left + gap, top + gap, wide, high},
        Legend{left + gap, far_y, wide, high}, Legend{far_x, far_y, wide, high}, Legend{middle, top + gap, wide, high},
        Legend{middle, far_y, wide, high}, Legend{far_x, half, wide, high}, Legend{left + gap, half, wide, high}}) {
    for (std::size_t c = 0; c < curves.size(); ++c)
      for (std::size_t i = 0; i < curves[c].size(); ++i) {
        const Pixel to = curves[c][i], from = i && !plot.curves[c].reference ? curves[c][i - 1] : to;
        const int parts = 1 + static_cast<int>(std::max(std::abs(to.x - from.x), std::abs(to.y - from.y)) / 4);
        for (int k = 1; k <= parts; ++k) {
          const double f = static_cast<double>(k) / parts, x = from.x + f * (to.x - from.x) - l.x,
                       y = from.y + f * (to.y - from.y) - l.y;
          l.hidden += x > -4 && x < l.wide + 4 && y > -4 && y < l.high + 4;
        }
      }
    if (best.hidden < 0 || l.hidden < best.hidden) best = l;
  }
  return best;
}

std::string text_of(const Legend& l, const Plot& plot, const std::vector<Pen>& pens) {
  std::string s = fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#fff\" fill-opacity=\"0.8\"/>\n", l.x,
      l.y, l.wide, l.high);
  double y = l.y + 1;
  for (std::size_t c = 0; c < plot.curves.size(); ++c) {
    if (plot.curves[c].name.empty()) continue;
    y += 17;
    const double x = l.x + 8;
    if (plot.curves[c].reference)
      s += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"none\" stroke=\"{}\"/>", x + 10, y - 4,
                       pens[c].color);
    else
      s += fmt::format("<path d=\"M{:.1f} {:.1f}h20\" stroke=\"{}\" {}/>", x, y - 4, pens[c].color, pens[c].line);
    s += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x + 26, y, escaped(plot.curves[c].name));
  }
  return s;
}

}  // namespace

std::string svg_of(const Plot& plot) {
  const Axis x = axis_of(plot, &Curve::x);
  Axis y = axis_of(plot, &Curve::y);
  std::vector<std::vector<Pixel>> curves;
  const auto lay_out = [&] {
    curves.clear();
    for (const Curve& curve : plot.curves) curves.push_back(pixels_of(curve, x, y));
    return legend_of(plot, curves);
  };
  Legend legend = lay_out();
  if (legend.hidden > 0) {
    // No place is free: make one above the curves.
    const double room = height - top - bottom;
    y.high = y.low + (y.high - y.low) * room / std::max(room - legend.high - 8, room / 2);
    legend = lay_out();
  }
  const auto at_x = [&](double v) { return left + (v - x.low) / (x.high - x.low) * (width - left - right); };
  const auto at_y = [&](double v) {
    return height - bottom - (v - y.low) / (y.high - y.low) * (height - top - bottom);
  };
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height);
  s += fmt::format("<text x=\"{}\" y=\"22\" font-size=\"15\">{}</text>\n", left, escaped(plot.title));
  for (int i = 0; i < x.ticks(); ++i)
    s += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4}</text>\n",
        at_x(x.tick(i)), top, height - bottom, height - bottom + 17, x.label(i));
  for (int i = 0; i < y.ticks(); ++i)
    s += fmt::format(
        "<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        at_y(y.tick(i)), left, width - right, left - 6, at_y(y.tick(i)) + 4, y.label(i));
  s += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2,
                   height - 12, escaped(plot.x_axis));
  s += fmt::format("<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                   (top + height - bottom) / 2, escaped(plot.y_axis));
  const std::vector<Pen> pens = pens_of(plot);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::string path;
    Pixel last{-1e9, -1e9};  // of the line: steps of less than a pixel are left out
    for (const Pixel& p : curves[c])
      if (plot.curves[c].reference)
        s += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"none\" stroke=\"{}\"/>\n", p.x, p.y,
                         pens[c].color);
      else if (std::max(std::abs(p.x - last.x), std::abs(p.y - last.y)) >= 1 || &p == &curves[c].back()) {
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", p.x, p.y);
        last = p;
      }
    if (!path.empty())
      s += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" {}/>\n", path, pens[c].color, pens[c].line);
  }
  s += text_of(legend, plot, pens);
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
