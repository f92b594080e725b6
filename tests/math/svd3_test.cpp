// F = U diag(s) V^T for random and nasty matrices: inverted, singular, equal, huge and tiny
// singular values.
#include "dreampm/math/svd3.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "matrices.h"

namespace dreampm::svd3_test {
namespace {
using namespace test;

template <class R>
struct Worst {
  double rebuild = 0, u = 0, v = 0, det_u = 0, det_v = 0;
  bool ordered = true;

  void check(const Mat3<R>& f) {
    const Svd3<R> d = svd3(f);
    const auto ud = static_cast<Mat3d>(d.u), vd = static_cast<Mat3d>(d.v);
    const auto fd = static_cast<Mat3d>(f);
    const Mat3d back = ud * Mat3d::diagonal(d.s.x, d.s.y, d.s.z) * transpose(vd);
    const double scale = std::max(std::sqrt(norm2(fd)), 1e-300);
    rebuild = std::max(rebuild, std::sqrt(norm2(back - fd)) / scale);
    u = std::max(u, std::sqrt(norm2(transpose(ud) * ud - Mat3d::identity())));
    v = std::max(v, std::sqrt(norm2(transpose(vd) * vd - Mat3d::identity())));
    det_u = std::max(det_u, std::abs(determinant(ud) - 1));
    det_v = std::max(det_v, std::abs(determinant(vd) - 1));
    const double slack = 1e-5 * scale;
    ordered = ordered && d.s.x + slack >= d.s.y && d.s.y + slack >= std::abs(d.s.z) && std::isfinite(d.s.z);
  }
};

template <class R>
Worst<R> worst_of(int count) {
  Rng rng(20261121);
  std::normal_distribution<double> g;
  std::uniform_real_distribution<double> uniform(-1, 1);
  Worst<R> worst;
  for (int i = 0; i < count; ++i) {
    Mat3<R> f;
    for (R& x : f.m) x = static_cast<R>(g(rng));
    worst.check(f);
    const double spread = sizeof(R) == 4 ? 8 : 30;
    auto value = [&] {
      static constexpr double special[] = {0, 1, 1, 1 + 1e-7, -1, 0.5};
      const int k = static_cast<int>(rng() % 12);
      return k < 6 ? special[k] : std::pow(10.0, spread * uniform(rng)) * (rng() % 4 ? 1 : -1);
    };
    worst.check(static_cast<Mat3<R>>(random_rotation(rng)) * Mat3<R>::diagonal(R(value()), R(value()), R(value())) *
                static_cast<Mat3<R>>(random_rotation(rng)));
  }
  for (double a : {0.0, 1.0, -1.0, 1e18, 1e-18})
    for (double b : {0.0, 1.0, -1.0, 1e18})
      for (double c : {0.0, 1.0, -1.0}) {
        worst.check(Mat3<R>::diagonal(R(a), R(b), R(c)));
        worst.check(outer(Vec3<R>{R(a), R(b), R(c)}, Vec3<R>{R(c), R(a), R(1)}));
      }
  return worst;
}

TEST(Svd3, MillionMatricesFloat) {
  const auto w = worst_of<float>(500000);
  EXPECT_LT(w.rebuild, 3e-6);
  EXPECT_LT(w.u, 4e-6);
  EXPECT_LT(w.v, 4e-6);
  EXPECT_LT(w.det_u, 4e-6);
  EXPECT_LT(w.det_v, 4e-6);
  EXPECT_TRUE(w.ordered);
}

TEST(Svd3, MillionMatricesDouble) {
  const auto w = worst_of<double>(500000);
  EXPECT_LT(w.rebuild, 2e-14);  // 90 epsilon: 21 rotations of a few epsilon each
  EXPECT_LT(w.u, 1e-14);
  EXPECT_LT(w.v, 1e-14);
  EXPECT_LT(w.det_u, 1e-14);
  EXPECT_LT(w.det_v, 1e-14);
  EXPECT_TRUE(w.ordered);
}

TEST(Svd3, InvertedMatrixHasOneNegativeValueAndTheNearestRotation) {
  const auto d = svd3(Mat3d::diagonal(2, 1, -0.5));
  EXPECT_NEAR(d.s.x, 2, 1e-15);
  EXPECT_NEAR(d.s.y, 1, 1e-15);
  EXPECT_NEAR(d.s.z, -0.5, 1e-15);
  EXPECT_LT(norm2(rotation_of(d) - Mat3d::identity()), 1e-28);
}

}  // namespace
}  // namespace dreampm::svd3_test
