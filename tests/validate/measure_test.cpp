// Measures must be right where the answer is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "dreampm/base/error.h"
#include "validate/measure/fit.h"
#include "validate/measure/hydrostatic.h"
#include "validate/measure/pairs.h"
#include "validate/measure/table.h"
#include "validate/measure/volume.h"

namespace dreampm::validate {
namespace {

TEST(Fit, OrderOfErrorsThatFallAsTheSquare) {
  EXPECT_NEAR(order_of({8, 16, 32}, {0.64, -0.16, 0.04}), 2, 1e-12);
  EXPECT_NEAR(slope_of({0, 1, 2}, {1, 3, 5}), 2, 1e-12);
}

TEST(Fit, AMeanOfDrawsIsKnownToItsStandardError) {
  // Deviations -3, -1, 1, 3: a variance of 20/3, of the mean a fourth of it.
  const Mean m = mean_of({-2, 0, 2, 4});
  EXPECT_DOUBLE_EQ(m.mean, 1);
  EXPECT_DOUBLE_EQ(m.uncertainty, std::sqrt(5.0 / 3));
  EXPECT_EQ(m.known(), m.uncertainty);
  EXPECT_EQ(mean_of({-5, -7}).known(), -6);
  EXPECT_EQ(mean_of({-5}).known(), -5) << "one draw knows of no chance";
}

TEST(Fit, InterpolatesBetweenPointsAndHoldsTheEnds) {
  EXPECT_DOUBLE_EQ(interpolate({0, 1, 3}, {0, 2, 4}, 2), 3);
  EXPECT_EQ(interpolate({0, 1, 3}, {0, 2, 4}, -1), 0);
  EXPECT_EQ(interpolate({0, 1, 3}, {0, 2, 4}, 9), 4);
}

TEST(Fit, SwingFindsPeriodAndDecay) {
  Swing s;
  for (double t = 0; t < 5; t += 0.01) s.add(t, std::exp(-0.1 * t) * std::sin(2 * std::numbers::pi * t / 1.25));
  // Chords of samples 0.01 apart miss a zero by less than 0.01^2.
  EXPECT_NEAR(s.period(), 1.25, 1e-4);
  EXPECT_EQ(s.zeros(), 7u);
  EXPECT_NEAR(s.extreme(4) / s.extreme(2), std::exp(-0.125), 1e-3);
}

TEST(Pairs, EachIsFoundOnceAcrossCells) {
  const std::vector<Vec3d> x{{0.9, 0, 0}, {1.1, 0, 0}, {-0.05, 0, 0}, {0.05, 0, 0}, {3, 3, 3}, {3, 3, 4}};
  std::vector<std::pair<std::size_t, std::size_t>> found;
  each_pair_within(x, 1, [&](std::size_t p, std::size_t q) { found.emplace_back(p, q); });
  std::sort(found.begin(), found.end());
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(found, (Pairs{{0, 1}, {0, 2}, {0, 3}, {2, 3}})) << "0.95, 0.85: near; 1.15, 1.05 and 1: not";
}

TEST(Pairs, PiecesHangTogetherByChains) {
  std::vector<Vec3d> x;
  for (int i = 0; i < 10; ++i) x.push_back({0.9 * i, 0, 0});
  for (int i = 0; i < 3; ++i) x.push_back({0.9 * i, -5, 0});
  x.push_back({0, 50, 0});
  EXPECT_EQ(pieces(x, 1), (std::vector<std::size_t>{10, 3, 1}));
  EXPECT_EQ(pieces(x, 0.5).size(), 14u);
}

/// A box of 0.4 x 0.2 m filled evenly, by a point in each 0.01 x 0.001 x 0.01 m, up to `top` of the
/// place along x.
template <class Top>
std::vector<Vec3d> filled(const Top& top) {
  std::vector<Vec3d> x;
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 20; ++k)
      for (double at = 0.01 * (i + 0.5), y = 0.0005; y < top(at); y += 0.001)
        x.push_back({1 + at, 2 + y, 3 + 0.01 * (k + 0.5)});
  return x;
}

TEST(Volume, OfAFlatAndOfAWavyLayer) {
  const Vec3d low{1, 2, 3}, high{1.4, 5, 3.2};
  const auto volume = [&](const auto& top) { return volume_by_columns(filled(top), low, high, 0.04); };
  EXPECT_NEAR(volume([](double) { return 0.1; }), 0.1 * 0.4 * 0.2, 1e-12);
  std::vector<Vec3d> swollen = filled([](double) { return 0.1; });
  for (Vec3d& p : swollen) p.y = 2 + 1.2 * (p.y - 2);
  EXPECT_NEAR(volume_by_columns(swollen, low, high, 0.04), 0.12 * 0.4 * 0.2, 1e-12);
  // Twice the mean height of all would be an eighth more: the variance of the heights over the
  // square of their mean.
  const auto wave = [](double x) { return 0.1 * (1 + 0.5 * std::cos(2 * std::numbers::pi * x / 0.4)); };
  EXPECT_NEAR(volume(wave) / (0.1 * 0.4 * 0.2), 1, 0.01);
  const auto half = filled([](double) { return 0.1; });
  std::vector<Vec3d> dry;
  for (const Vec3d& p : half)
    if (p.x < 1.2) dry.push_back(p);
  EXPECT_NEAR(volume_by_columns(dry, low, high, 0.04), 0.1 * 0.2 * 0.2, 1e-12) << "a dry half holds nothing";
  EXPECT_THROW(volume_by_columns({{0.9, 2, 3}}, low, high, 0.04), std::invalid_argument);
}

TEST(Hydrostatic, PressureOfTheInitialHeight) {
  Values v;
  v.set("bulk_modulus", 2e4);  // soft: a column of 1 m is pressed by a tenth and more
  v.with_defaults(Newtonian::info.params);
  for (const double gamma : {7.0, -1.0}) {
    v.set("gamma", gamma);
    const Hydrostatic rest(v, 9.81, 1);
    for (const double Y : {0.0, 0.25, 0.7, 0.99}) {
      EXPECT_NEAR(rest.pressure_at(rest.pressed(Y)), 9810 * (1 - Y), 1e-2);
      EXPECT_NEAR(rest.pressure(rest.strain(9810 * (1 - Y))), 9810 * (1 - Y), 1e-6);
      // dy = J dY
      EXPECT_NEAR((rest.pressed(Y + 0.005) - rest.pressed(Y - 0.005)) / (Y > 0 ? 0.01 : 0.005),
                  1 + rest.strain(9810 * (1 - Y)), 2e-3);
    }
  }
}

TEST(Hydrostatic, TheLinearLawsHeightIsKnown) {
  // J = 1 - rho g (H - Y)/K: y(H) = H - rho g H^2/(2 K).
  Values v;
  v.set("bulk_modulus", 5e4);
  v.set("gamma", -1);
  v.with_defaults(Newtonian::info.params);
  EXPECT_NEAR(Hydrostatic(v, 10, 1).pressed(1), 1 - 1e4 / 1e5, 1e-9);
}

TEST(Table, ReadsRowsUnderComments) {
  const Table t("# source\n# more\ncase,x,note\na,1.5,use this\nb,-2e3,\na,3,one, two\n", "t.csv");
  EXPECT_EQ(t.size(), 3u);
  EXPECT_EQ(t.number(1, "x"), -2000);
  EXPECT_EQ(t.where("case", "a").numbers("x"), (std::vector<double>{1.5, 3}));
  EXPECT_EQ(t.text(2, "note"), "one, two");
}

TEST(Table, NamesWhatIsWrong) {
  const auto message = [](const std::string& text, const char* column) {
    try {
      Table(text, "t.csv").numbers(column);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_EQ(message("x,y\n1,2\n1,?\n", "y"), "t.csv: row 2, y: '?' is no number");
  EXPECT_EQ(message("x,y\n1,2\n", "z"), "t.csv: there is no column z");
  EXPECT_EQ(message("x,y\n1\n", "x"), "t.csv: a row of 1 cells, the head has 2: 1");
}

}  // namespace
}  // namespace dreampm::validate
