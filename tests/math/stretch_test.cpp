// Functions of the stretches of F = U diag(s) V^T with known U, s and V, beside those by way of the
// decomposition.
#include "dreampm/math/stretch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "matrices.h"

namespace dreampm::stretch_test {
namespace {
using namespace test;

/// t(s), a clamp, and f(s), zero at rest as a stress is.
template <class R>
Vec3<R> clamped(const Vec3<R>& s) {
  const auto one = [](R x) { return std::min(std::max(x, R(0.975)), R(1.0075)); };
  return {one(s.x), one(s.y), one(s.z)};
}
template <class R>
Vec3<R> stressed(const Vec3<R>& s) {
  const auto one = [](R x) { return (x - R(1)) * x; };
  return {one(s.x), one(s.y), one(s.z)};
}

template <class R>
Mat3<R> put_together(const Mat3<R>& left, const Vec3<R>& a, const Mat3<R>& right) {
  return left * Mat3<R>::diagonal(a.x, a.y, a.z) * transpose(right);
}

/// The largest errors of U t(s) V^T and U f(s) U^T, in epsilon.
struct Errors {
  double clamp = 0, stress = 0;

  template <class R>
  void see(const Mat3d& f_error, const Mat3d& tau_error) {
    for (int k = 0; k < 9; ++k) see(clamp, f_error.m[k], std::numeric_limits<R>::epsilon());
    for (int k = 0; k < 9; ++k) see(stress, tau_error.m[k], std::numeric_limits<R>::epsilon());
  }
  static void see(double& worst, double error, double epsilon) {
    const double x = std::abs(error) / epsilon;
    worst = x <= worst ? worst : x;  // NaN stays
  }
};

/// By the functions under test, and by the decomposition.
template <class R>
struct Compared {
  Errors closed, decomposed;

  void see(const Mat3d& u, const Vec3d& s, const Mat3d& v) {
    const Mat3d kept = put_together(u, clamped(s), v), tau = put_together(u, stressed(s), u);
    const auto f = static_cast<Mat3<R>>(put_together(u, s, v));
    const Stretches<R> parts = stretches_of(f, least_for_parts), functions = stretches_of(f, least_for_functions);
    closed.see<R>(static_cast<Mat3d>(parts.with(clamped(parts.s))) - kept,
                  static_cast<Mat3d>(functions.function(stressed(functions.s)).full()) - tau);
    const Svd3<R> e = svd3(f);
    decomposed.see<R>(static_cast<Mat3d>(put_together(e.u, clamped(e.s), e.v)) - kept,
                      static_cast<Mat3d>(put_together(e.u, stressed(e.s), e.u)) - tau);
  }
  void print(const char* what) const {
    std::printf("%s: errors in epsilon: F %.1f, stress %.1f; by the decomposition %.1f, %.1f\n", what, closed.clamp,
                closed.stress, decomposed.clamp, decomposed.stress);
  }
};

/// Random rotations with stretches in 1 +- strain: any, two nearly equal, two equal, three nearly
/// equal, three equal.
template <class R>
Compared<R> compared(double strain, int count) {
  Compared<R> c;
  Rng rng(5);
  for (int i = 0; i < count; ++i) {
    const auto stretch = [&] { return 1 + between(rng, -strain, strain); };
    const auto near = [&](double x) { return x * (1 + strain * std::pow(10.0, between(rng, -8, -1))); };
    Vec3d s{stretch(), stretch(), stretch()};
    if (i % 4 == 1) s.y = near(s.x);
    if (i % 4 == 2) s.y = i % 8 == 2 ? s.x : near(s.x), s.z = near(s.x);
    if (i % 16 == 3) s = {s.x, s.x, i % 32 == 3 ? s.x : s.z};
    if (i % 16 == 7) s = {s.x, s.y, 0.975};  // on the edge of the clamp, beside one just within
    if (i % 32 == 7) s.y = 0.975 + 1e-4 * strain * between(rng, 0, 1);
    c.see(i % 5 ? random_rotation(rng) : Mat3d::identity(), s, i % 3 ? random_rotation(rng) : Mat3d::identity());
  }
  return c;
}

template <class R>
void is_exact() {
  for (const double strain : {1e-3, 0.03, 0.3}) {
    const Compared<R> c = compared<R>(strain, 200000);
    c.print(("strain " + std::to_string(strain)).c_str());
    EXPECT_LE(c.closed.clamp, 8);
    EXPECT_LE(c.closed.stress, 8);
  }
}
TEST(Stretch, AsExactAsTheDecompositionFloat) { is_exact<float>(); }
TEST(Stretch, AsExactAsTheDecompositionDouble) { is_exact<double>(); }

/// Up to the borders from which F is decomposed, and beyond.
template <class R>
void holds_to_the_borders() {
  for (const double least : {least_for_parts, least_for_functions}) {
    Compared<R> c;
    Rng rng(7);
    for (int i = 0; i < 100000; ++i) {
      const double largest = between(rng, 1, 3), smallest = largest * std::sqrt(least) * (i % 8 ? 1.0001 : 0.9);
      const auto stretch = [&] {
        return i % 3 == 0 ? between(rng, smallest, largest) : rng() % 2 ? largest : smallest;
      };
      c.see(random_rotation(rng), {stretch(), stretch(), stretch()}, random_rotation(rng));
    }
    c.print(("to the border of " + std::to_string(least)).c_str());
    EXPECT_LE(c.closed.clamp, 24);
    EXPECT_LE(c.closed.stress, 1.5 * c.decomposed.stress);
  }
}
TEST(Stretch, HoldsToTheBordersFloat) { holds_to_the_borders<float>(); }
TEST(Stretch, HoldsToTheBordersDouble) { holds_to_the_borders<double>(); }

TEST(Stretch, AtRestNothingIsLeft) {
  const Stretches<float> d = stretches_of(Mat3f::identity(), least_for_parts);
  EXPECT_EQ(d.s, (Vec3f{1, 1, 1}));
  const Mat3f tau = d.function(stressed(d.s)).full(), f = d.with(d.s);
  for (int k = 0; k < 9; ++k) {
    EXPECT_EQ(tau.m[k], 0);
    EXPECT_EQ(f.m[k], Mat3f::identity().m[k]);
  }
}

template <class R>
void wild() {
  // Flat, inverted, crushed, torn: what has no inverse, or none that floats could resolve.
  Rng rng(6);
  Compared<R> c;
  const double tiny = 1e-4, far = 40;
  for (int i = 0; i < 2000; ++i)
    for (const Vec3d& s : {Vec3d{1.2, 0.9, 0}, Vec3d{1.2, 0.9, -0.5}, Vec3d{1, 0.9, -0.7}, Vec3d{1.2, 0.1, 0.02},
                           Vec3d{far, 1, tiny}, Vec3d{far, 0.5 * far, -0.2 * far}, Vec3d{far, 10, 3}})
      c.see(random_rotation(rng), s, random_rotation(rng));
  c.print("wild");
  EXPECT_LE(c.closed.clamp, c.decomposed.clamp + 8);
  EXPECT_LE(c.closed.stress, 16 * far * far);
  // Nothing is known of the frame where two stretches vanish; but what is made of it is bounded.
  for (const Mat3<R>& f : {Mat3<R>{}, outer(Vec3<R>{1, 0, 0}, Vec3<R>{0, 1, 0}), Mat3<R>::diagonal(-1, -1, -1)}) {
    const Stretches<R> d = stretches_of(f, least_for_parts);
    EXPECT_NEAR(std::abs(determinant(d.with(clamped(d.s)))), 1, 0.08);
    for (const R x : d.function(stressed(d.s)).full().m) EXPECT_LE(std::abs(x), R(2.1));
  }
}
TEST(Stretch, WildOnesAreDecomposedFloat) { wild<float>(); }
TEST(Stretch, WildOnesAreDecomposedDouble) { wild<double>(); }

}  // namespace
}  // namespace dreampm::stretch_test
