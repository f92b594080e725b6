// exp and log against the standard library, over their whole range.
#include "dreampm/math/explog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dreampm::explog_test {
namespace {

template <class R>
double ulps(R got, double want) {
  return std::abs(static_cast<double>(got) - want) / (std::abs(want) * std::numeric_limits<R>::epsilon());
}

template <class R>
void check_exp(double low, double high, double allowed) {
  double worst = 0;
  for (int i = 0; i <= 200000; ++i) {
    const R a = static_cast<R>(low + (high - low) * i / 200000);
    worst = std::max(worst, ulps(exp(a), static_cast<double>(std::exp(static_cast<long double>(a)))));
  }
  EXPECT_LT(worst, allowed);
}
TEST(Exp, FloatWholeRange) { check_exp<float>(-87, 88, 2.5); }
TEST(Exp, DoubleWholeRange) { check_exp<double>(-708, 709, 2.5); }

template <class R>
void check_log(double decades, double allowed) {
  double worst = 0;
  for (int i = -100000; i <= 100000; ++i) {
    const R a = static_cast<R>(std::pow(10.0, decades * i / 100000));
    const double want = static_cast<double>(std::log(static_cast<long double>(a)));
    if (std::abs(want) > 0.01) worst = std::max(worst, ulps(log(a), want));
  }
  EXPECT_LT(worst, allowed);
}
TEST(Log, FloatWholeRange) { check_log<float>(37, 4); }
TEST(Log, DoubleWholeRange) { check_log<double>(300, 4); }

TEST(Log, NearOneTheErrorIsOfTheArgument) {
  for (double e : {1e-3, 1e-6, 1e-9, -1e-6}) EXPECT_NEAR(log(1 + e), std::log1p((1 + e) - 1), 1e-16);
}

}  // namespace
}  // namespace dreampm::explog_test
