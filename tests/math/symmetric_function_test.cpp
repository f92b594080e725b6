// f(A) of symmetric matrices with known eigenvectors: spread, nearly equal and equal eigenvalues,
// in every order.
#include "dreampm/math/symmetric_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "matrices.h"

namespace dreampm::symmetric_function_test {
namespace {
using namespace test;

Mat3d made_of(const Mat3d& q, const Vec3d& a) { return q * Mat3d::diagonal(a.x, a.y, a.z) * transpose(q); }

template <class R>
Sym3<R> rounded(const Mat3d& a) {
  const Sym3<double> s = symmetric_part(a);
  return {R(s.xx), R(s.yy), R(s.zz), R(s.xy), R(s.xz), R(s.yz)};
}

/// Errors in units of epsilon |A|.
template <class R>
struct Worst {
  double values = 0, smooth = 0, kinked = 0;

  void check(const Mat3d& q, const Vec3d& a) {
    const Mat3d whole = made_of(q, a);
    const double size = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z), 1e-30});
    const double unit = size * static_cast<double>(std::numeric_limits<R>::epsilon());
    const Spectrum3<R> s = spectrum_of(rounded<R>(whole));
    std::array<double, 3> found{double(s.apart), double(s.middle), double(s.other)}, known{a.x, a.y, a.z};
    std::sort(found.begin(), found.end());
    std::sort(known.begin(), known.end());
    for (std::size_t i = 0; i < 3; ++i) see(values, std::abs(found[i] - known[i]) / unit);
    // |f| of the size of A and slopes up to 1, so that a rounding error of A itself stays one.
    const auto parabola = [&](auto x) { return x + x * x * static_cast<decltype(x)>(0.3 / size); };
    const auto clamp = [&](auto x) {
      using X = decltype(x);
      return std::min(std::max(x, static_cast<X>(-0.4 * size)), static_cast<X>(known[1]));  // at the middle one
    };
    see(smooth, error(s, q, a, parabola) / unit);
    see(kinked, error(s, q, a, clamp) / unit);
  }

  template <class F>
  double error(const Spectrum3<R>& s, const Mat3d& q, const Vec3d& a, const F& f) {
    const Sym3<R> got = s.function(f(s.apart), f(s.middle), f(s.other));
    return std::sqrt(norm2(static_cast<Mat3d>(got.full()) - made_of(q, {f(a.x), f(a.y), f(a.z)})));
  }

  static void see(double& worst, double x) { worst = x <= worst ? worst : x; }  // NaN stays
};

template <class R>
Worst<R> worst_of(int count) {
  Rng rng(20261122);
  Worst<R> worst;
  for (int i = 0; i < count; ++i) {
    const Mat3d q = i % 8 ? random_rotation(rng) : Mat3d::identity();
    const double size = std::pow(10.0, between(rng, -3, 3));
    const auto value = [&] { return size * between(rng, -1, 1); };
    // Two of them closer and closer, at any distance from the third; and equal ones.
    const double x = value(), gap = i % 5 ? size * std::pow(10.0, between(rng, -17, 0)) : 0;
    const double third = i % 7 ? value() : x + size * std::pow(10.0, between(rng, -17, 0));
    std::array<double, 3> a{x, x + gap, third};
    std::shuffle(a.begin(), a.end(), rng);
    worst.check(q, {a[0], a[1], a[2]});
    worst.check(q, {x, x, x});
  }
  std::printf("errors in epsilon |A|: eigenvalues %.1f, smooth f %.1f, clamp %.1f\n", worst.values, worst.smooth,
              worst.kinked);
  return worst;
}

template <class R>
void is_exact() {
  const Worst<R> worst = worst_of<R>(400000);
  EXPECT_LT(worst.values, 8);
  EXPECT_LT(worst.smooth, 16);
  EXPECT_LT(worst.kinked, 16);
}
TEST(SymmetricFunction, OfAnyEigenvaluesFloat) { is_exact<float>(); }
TEST(SymmetricFunction, OfAnyEigenvaluesDouble) { is_exact<double>(); }

TEST(SymmetricFunction, OfAMultipleOfOneIsExactlyOne) {
  for (const float x : {0.0f, 1e-30f, 1e-8f, -0.3f, 1.0f, 77.0f}) {
    const auto s = spectrum_of(Sym3<float>::isotropic(x));
    EXPECT_EQ(s.apart, x);
    EXPECT_EQ(s.middle, x);
    EXPECT_EQ(s.other, x);
    const Sym3<float> f = s.function(0.7f, 0.7f, 0.7f);
    EXPECT_EQ(f.xx, 0.7f);
    EXPECT_EQ(f.yy, 0.7f);
    EXPECT_EQ(f.zz, 0.7f);
    EXPECT_EQ(std::abs(f.xy) + std::abs(f.xz) + std::abs(f.yz), 0);
  }
}

TEST(SymmetricFunction, NamesTheOneThatStandsApart) {
  const auto above = spectrum_of(Sym3<double>{1, 5, 2, 0, 0, 0});
  EXPECT_NEAR(above.apart, 5, 1e-15);
  EXPECT_NEAR(above.middle, 2, 1e-15);
  EXPECT_NEAR(above.other, 1, 1e-15);
  const auto below = spectrum_of(Sym3<double>{5, 1, 4, 0, 0, 0});
  EXPECT_NEAR(below.apart, 1, 1e-15);
  EXPECT_NEAR(below.middle, 4, 1e-15);
  EXPECT_NEAR(below.other, 5, 1e-15);
}

TEST(SymmetricFunction, CosineOfAThirdOfTheAngle) {
  double single = 0, twice = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double r = i * 1e-5;
    const float rounded = static_cast<float>(r);
    single = std::max(single, std::abs(static_cast<double>(spectrum_detail::cosine_of_third(rounded)) -
                                       std::cos(std::acos(static_cast<double>(rounded)) / 3)));
    twice = std::max(twice, std::abs(spectrum_detail::cosine_of_third(r) - std::cos(std::acos(r) / 3)));
  }
  std::printf("cos(acos(r)/3): float %.2g, double %.2g\n", single, twice);
  EXPECT_LT(single, 1.5 * static_cast<double>(std::numeric_limits<float>::epsilon()));
  EXPECT_LT(twice, 4 * std::numeric_limits<double>::epsilon());
}

}  // namespace
}  // namespace dreampm::symmetric_function_test
