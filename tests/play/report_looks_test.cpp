// What the report's slider shows, each look by one click, in both presets.
#include "dreampm/play/report_looks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "small_stage.h"

namespace dreampm::play {
namespace {
using namespace test;
using testing::HasSubstr;

/// Where a material lies [m]. Sizes are those of the middle 90 % of its particles.
struct Shape {
  double width, height, bottom, top, middle;
};
Shape shape_of(Playground& p, const std::string& material) {
  const std::shared_ptr<const Frame> frame = p.frame();
  for (const MatterFrame& m : frame->matter) {
    if (m.name != material) continue;
    std::vector<double> along[3];
    double sum = 0;
    for (const Vec3f& x : m.position) {
      for (int a = 0; a < 3; ++a) along[a].push_back(static_cast<double>(x[a]));
      sum += static_cast<double>(x.y);
    }
    for (std::vector<double>& a : along) std::sort(a.begin(), a.end());
    const auto at = [&](int a, double share) {
      return along[a][static_cast<std::size_t>(share * static_cast<double>(along[a].size() - 1))];
    };
    const auto size = [&](int a) { return at(a, 0.95) - at(a, 0.05); };
    return {std::max(size(0), size(2)), size(1), at(1, 0), at(1, 1), sum / static_cast<double>(along[1].size())};
  }
  throw std::out_of_range(material);
}

/// Plays a look for so many drawn frames, of 25 steps of 0.2 ms, and keeps the most substeps of
/// one.
struct Played {
  Playground p;
  int most_substeps = 0;
  double highest = 0;  ///< of the middle, after it was lowest [m]
  double lowest = 1;

  Played(std::string_view look, std::size_t preset, int frames) : p(load_stage("report", preset), quiet_options()) {
    play(p, {"look " + std::string(look)});
    for (int n = 0; n < frames; ++n) {
      most_substeps = std::max(most_substeps, p.tick({}));
      const double middle = shape_of(p, "diy").middle;
      if (middle < lowest) lowest = highest = middle;
      highest = std::max(highest, middle);
    }
    EXPECT_NEAR(p.simulation().time(), frames * 25 * 2e-4, 1e-3);
  }
  Shape shape(const std::string& material = "diy") { return shape_of(p, material); }
};

constexpr int second = 200;  ///< drawn frames

TEST(DISABLED_ReportLooks, Print) {
  for (const ReportLook& look : report_looks())
    for (std::size_t preset : {0u, 1u}) {
      Playground p(load_stage("report", preset), quiet_options());
      play(p, {"look " + std::string(look.name)});
      int most = 0;
      long sum = 0;
      for (int n = 1; n <= 400; ++n) {
        const int s = p.tick({});
        most = std::max(most, s), sum += s;
        if (n % 40 == 0 || (n < 120 && n % 10 == 0)) {
          const Shape d = shape_of(p, "diy"), c = preset ? shape_of(p, "cube") : d;
          std::printf(
              "%s %zu t %.2f width %.3f height %.3f y %.3f..%.3f middle %.3f  cube middle %.3f y %.3f..%.3f substeps "
              "%d most %d mean %.1f\n",
              look.name.data(), preset + 1, p.simulation().time(), d.width, d.height, d.bottom, d.top, d.middle,
              c.middle, c.bottom, c.top, s, most, double(sum) / n);
        }
      }
    }
}

}  // namespace
}  // namespace dreampm::play
