#include "dreampm/surface/carry.h"

#include <gtest/gtest.h>

#include "clouds.h"
#include "dreampm/base/parallel.h"
#include "dreampm/surface/surface.h"

namespace dreampm::surface {
namespace {

constexpr float kH = 0.02f;

/// A ball of particles and its mesh.
struct Ball {
  Vec3f center{0.2f, 0.2f, 0.2f};
  std::vector<Vec3f> points =
      test::lattice(kH, center * 2.0f, [&](const Vec3f& p) { return length(p - center) < 0.12f; });
  TriMesh mesh = reconstruct({.positions = points, .spacing = kH}).mesh;
  Carriers carriers() const { return {points, kH}; }
  template <class F>
  auto each(const F& f) const {
    std::vector<decltype(f(points[0]))> values;
    for (const Vec3f& p : points) values.push_back(f(p));
    return values;
  }
};

TEST(Carry, AConstantIsItself) {
  const Ball ball;
  for (const float v : carry_numbers(ball.mesh.vertices, ball.carriers(), ball.each([](const Vec3f&) { return 2.5f; })))
    EXPECT_NEAR(v, 2.5f, 1e-5f);
}

TEST(Carry, AFieldIsCarriedToWithinASpacing) {
  const Ball ball;
  const auto got = carry_numbers(ball.mesh.vertices, ball.carriers(), ball.each([](const Vec3f& p) { return p.x; }));
  // The mean lies among the particles, up to two thirds of a spacing below the surface.
  for (std::size_t v = 0; v < got.size(); ++v) EXPECT_NEAR(got[v], ball.mesh.vertices[v].x, kH);
}

TEST(Carry, NamesAreNotMixed) {
  const Ball ball;
  const auto left = [&](const Vec3f& p) { return p.x < ball.center.x; };
  const auto got = carry_names(ball.mesh.vertices, ball.carriers(),
                               ball.each([&](const Vec3f& p) { return left(p) ? 3.0f : 7.0f; }));
  for (std::size_t v = 0; v < got.size(); ++v) {
    const Vec3f& x = ball.mesh.vertices[v];
    EXPECT_TRUE(got[v] == 3 || got[v] == 7);
    if (std::abs(x.x - ball.center.x) > kH) {
      EXPECT_EQ(got[v], left(x) ? 3.0f : 7.0f);
    }
  }
}

TEST(Carry, BlueBesideYellowIsGreenBetween) {
  const Ball ball;
  const Vec3f blue{0.01f, 0.07f, 0.6f}, yellow{1, 0.8f, 0.01f};
  const auto colors = ball.each([&](const Vec3f& p) { return p.x < ball.center.x ? blue : yellow; });
  const auto got = carry_colors(ball.mesh.vertices, ball.carriers(), colors, Mixing::opaque);
  int between = 0;
  for (std::size_t v = 0; v < got.size(); ++v) {
    const float off = ball.mesh.vertices[v].x - ball.center.x;
    if (std::abs(off) > 2 * kH) {
      const Vec3f& own = off < 0 ? blue : yellow;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[v][c], own[c], 1e-5f);
    } else if (std::abs(off) < 0.1f * kH) {
      ++between;
      EXPECT_GT(got[v].y, got[v].x);
      EXPECT_GT(got[v].y, got[v].z);
    }
  }
  EXPECT_GT(between, 4);
}

TEST(Carry, TheVorticityOfATurnIsTwiceItsSpin) {
  const Ball ball;
  const Vec3f spin{1, -2, 4};
  const auto got = carry_vorticity(ball.mesh.vertices, ball.carriers(),
                                   ball.each([&](const Vec3f& p) { return Vec3f{3, 0, 1} + cross(spin, p); }));
  // Off by what keeps the fit finite where particles are few: 0.001 of the reach squared, beside a
  // variance of particles on one side of about 0.03 of it.
  for (const Vec3f& w : got)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(w[c], 2 * spin[c], 0.06f * length(spin) * 2);
}

TEST(Carry, AVertexFarFromAllTakesTheNearest) {
  const std::vector<Vec3f> points{{0, 0, 0}, {0.1f, 0, 0}}, vertices{{0.9f, 0, 0}};
  EXPECT_EQ(carry_names(vertices, {points, 0.01f}, std::vector<float>{1, 2})[0], 2);
  EXPECT_EQ(carry_numbers(vertices, {points, 0.01f}, std::vector<float>{1, 2})[0], 2)
      << "the farther one does not count";
}

TEST(Carry, OneThreadGivesTheSameBits) {
  const Ball ball;
  const auto colors = ball.each([](const Vec3f& p) { return Vec3f{p.x, p.y, p.z}; });
  const auto many = carry_colors(ball.mesh.vertices, ball.carriers(), colors, Mixing::clear);
  const ThreadLimit one(1);
  EXPECT_EQ(carry_colors(ball.mesh.vertices, ball.carriers(), colors, Mixing::clear), many);
}

}  // namespace
}  // namespace dreampm::surface
