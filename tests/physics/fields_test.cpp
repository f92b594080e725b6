// The head of a force field: the most energy that it can give to matter on its way, against the
// field's own steps.
#include "dreampm/physics/fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dreampm/math/rng.h"

namespace dreampm {
namespace {

const Passage closed{{{0.5, 0, 0}, {0.75, 0.25, 0.5}}, {{0, 0, 0}, {1, 0.5, 0.5}}, {}};

/// Returns the acceleration of the field on matter at x that moves at v [m/s^2].
template <class F>
Vec3d acceleration(const F& f, const Vec3d& x, const Vec3d& v = {}) {
  constexpr double dt = 1e-7;
  return (F::template Step<double>::of(f, dt)(v, x) - v) / dt;
}

/// Returns the energy that the field gives to matter that is led slowly from a to b: by its action
/// on matter at rest.
template <class F>
double led(const F& f, const Vec3d& a, const Vec3d& b) {
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += dot(acceleration(f, a + (b - a) * ((i + 0.5) / n)), b - a) / n;
  return sum;
}

/// The largest kinetic energy [m^2/s^2] of a body that is let go at x, and moves for `seconds`
/// between walls that throw it back, or round and round where the passage is endless.
template <class F>
double let_go(const F& f, const Passage& p, Vec3d x, double seconds) {
  constexpr double dt = 1e-4;
  const auto step = F::template Step<double>::of(f, dt);
  Vec3d v{};
  double most = 0;
  for (int n = 0; n < seconds / dt; ++n) {
    v = step(v, x);
    x += v * dt;
    for (int a = 0; a < 3; ++a) {
      const double low = p.within.min[a], high = p.within.max[a];
      if (x[a] >= low && x[a] <= high) continue;
      if (p.endless[static_cast<std::size_t>(a)])
        x[a] += x[a] < low ? high - low : low - high;
      else
        x[a] = std::clamp(x[a], low, high), v[a] = -v[a];
    }
    most = std::max(most, dot(v, v) / 2);
  }
  return most;
}

/// The most from any of many places of `from`, its corners among them.
template <class F>
double let_go(const F& f, const Passage& p, double seconds) {
  double most = 0;
  for (int i = 0; i < 40; ++i) {
    Vec3d x;
    for (int a = 0; a < 3; ++a) {
      const double at = i < 8 ? i >> a & 1 : uniform(7, static_cast<std::uint64_t>(3 * i + a));
      x[a] = p.from.min[a] + at * (p.from.max[a] - p.from.min[a]);
    }
    most = std::max(most, let_go(f, p, x, seconds));
  }
  return most;
}

// The step is 1e-7 s: beside 1 that loses rate dt, here 4e-6 at most.
constexpr double step_error = 1e-5;

TEST(FieldHead, OfWindIsThatOfMatterHeldBack) {
  const Wind wind{{15, 0, 0}, 2};
  EXPECT_NEAR(wind.head(closed), 2 * 15 * 15 * 0.5, 1e-9) << "k w^2 L, from the matter's far end to the wall";
  EXPECT_NEAR(led(wind, {0.5, 0, 0}, {1, 0, 0}), wind.head(closed), step_error * wind.head(closed));
  const Wind back{{-4, 3, 0}, 2};
  EXPECT_NEAR(led(back, {0.75, 0, 0.2}, {0, 0.5, 0.2}), back.head(closed), step_error * back.head(closed));
  EXPECT_EQ((Wind{{15, 0, 0}, 0}).head(closed), 0);
}

TEST(FieldHead, OfDragIsThatOfMatterHeldBackAndNothingToRest) {
  const Drag drag{40, {1, -2, 0.5}};
  EXPECT_NEAR(led(drag, {0.5, 0.25, 0}, {1, 0, 0.5}), drag.head(closed), step_error * drag.head(closed));
  EXPECT_EQ((Drag{1e9, {}}).head(closed), 0);
}

TEST(FieldHead, OfABrushBoundsWhatItGivesOnTheWayThroughIt) {
  const Brush brush{{0.6, 0.2, 0.2}, 0.1, {2, 0, 0}, 30};
  EXPECT_LT(led(brush, {0.5, 0.2, 0.2}, {0.7, 0.2, 0.2}), brush.head(closed));
  EXPECT_GT(led(brush, {0.5, 0.2, 0.2}, {0.7, 0.2, 0.2}), 0.4 * brush.head(closed));
  EXPECT_EQ((Brush{{0.6, 0.2, 0.2}, 0.1, {}, 1e9}).head(closed), 0);
  EXPECT_EQ((Brush{{5, 5, 5}, 0.1, {2, 0, 0}, 30}).head(closed), 0) << "where no matter comes";
  const auto step = Brush::Step<double>::of(brush, 1e3);
  EXPECT_LT(length(step({0, 7, 0}, {0.6, 0.2, 0.2}) - Vec3d{2, 0, 0}), 1e-9) << "any rate is stable";
  EXPECT_EQ(step({0, 7, 0}, {0.6, 0.31, 0.2}), (Vec3d{0, 7, 0})) << "outside nothing happens";
}

TEST(FieldHead, OfAnAttractorIsTheDepthOfItsPotential) {
  // Inside, outside, and pushing; the places are the ends of the way by hand.
  const Attractor inside{{0.2, 0.4, 0.1}, 0.5, 0.05}, outside{{-0.5, 0.2, 0.1}, 0.5, 0.05},
      pushes{{0.6, 0.1, 0.1}, -0.5, 0.05};
  EXPECT_NEAR(led(inside, {0.75, 0, 0.5}, {0.2, 0.4, 0.1}), inside.head(closed), 1e-5 * inside.head(closed));
  EXPECT_NEAR(led(outside, {0.75, 0, 0.5}, {0, 0.2, 0.1}), outside.head(closed), 1e-5 * outside.head(closed));
  EXPECT_NEAR(led(pushes, {0.6, 0.1, 0.1}, {0, 0.5, 0.5}), pushes.head(closed), 1e-5 * pushes.head(closed));
  EXPECT_EQ((Attractor{{9, 9, 9}, 0, 0.1}).head(closed), 0);
}

/// 1 %: the attractor's explicit steps, of which a fall takes some hundred.
TEST(FieldHead, NoFallThroughAFieldIsDeeper) {
  const auto expect_bound = [](const auto& f, const Passage& p, double at_least) {
    const double most = let_go(f, p, 2);
    EXPECT_LT(most, 1.01 * f.head(p));
    EXPECT_GT(most, at_least * f.head(p)) << "the bound is no fancy";
  };
  expect_bound(Wind{{3, 0, 0}, 0.05}, closed, 0.7);  // what the wind loses by blowing after matter
  expect_bound(Wind{{-4, 3, 1}, 0.5}, closed, 0.2);
  expect_bound(Drag{0.5, {3, 0, 0}}, closed, 0.5);
  expect_bound(Drag{20, {3, -1, 0}}, closed, 0.05);  // held back it presses with all of it; let go it comes to u only
  expect_bound(Attractor{{0.2, 0.4, 0.1}, 0.5, 0.05}, closed, 0.9);
  expect_bound(Attractor{{0.6, 0.1, 0.1}, -0.5, 0.05}, closed, 0.4);  // nothing is let go at the very point
}

TEST(FieldHead, RoundByRoundMatterComesToTheSpeedOfTheWind) {
  Passage p{closed.within, closed.within, {true, false, false}};
  const Wind wind{{3, 0, 0}, 2};
  const Drag drag{2, {3, 0, 0}};
  const Wind weak{{3, 0, 0}, 0.05};
  EXPECT_NEAR(wind.head(p), 2 * 9 * 1 + 4.5, 1e-9);
  EXPECT_NEAR(drag.head(p), 2 * 3 * 1 + 4.5, 1e-9);
  EXPECT_NEAR(let_go(wind, p, {0.5, 0.2, 0.2}, 20), 4.5, 0.1);
  EXPECT_GT(let_go(weak, p, {0.5, 0.2, 0.2}, 40), 5 * weak.head({p.from, p.within, {}})) << "one round gives less";
  EXPECT_LT(let_go(weak, p, {0.5, 0.2, 0.2}, 40), weak.head(p));
  p.endless = {false, true, false};
  EXPECT_NEAR(wind.head(p), 2 * 9 * 1, 1e-9) << "it blows across the way round";
}

}  // namespace
}  // namespace dreampm
