#include "dreampm/surface/volume_taken.h"

#include <gtest/gtest.h>

#include "clouds.h"
#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

constexpr float h = 0.01f;

/// Returns the volume of a cloud over that at rest, in a box whose sides and floor are walls if
/// `walled`.
double taken(const std::vector<Vec3f>& points, const Vec3f& size, bool walled) {
  SurfaceInput in;
  in.positions = points;
  in.spacing = h;
  in.walls = {{0, 0, 0}, {size.x, 10, size.z}};
  if (walled) in.is_wall = {true, true, true, false, true, true};
  return volume_taken(in) / (static_cast<double>(points.size()) * 1e-6);
}
constexpr auto all = [](const Vec3f&) { return true; };

std::vector<Vec3f> stretched(std::vector<Vec3f> points, float by) {
  for (Vec3f& p : points) p.y *= by;
  return points;
}

// Layers of 3 to 16 spacings between walls, points all over their cells of the lattice: a reading
// scatters by a tenth of itself where a kernel holds some 10 particles, and 1 over it is off by
// half of its square in the mean.
constexpr double slack = 0.03;

TEST(VolumeTaken, ALayerAtRestTakesItsOwnVolume) {
  for (const float depth : {0.03f, 0.04f, 0.08f, 0.16f})
    for (const float jitter : {0.0f, 0.35f, 0.5f}) {
      const Vec3f size{0.4f, depth, 0.2f};
      EXPECT_NEAR(taken(test::lattice(h, size, all, jitter), size, true), 1, slack) << depth << ", " << jitter;
    }
}

TEST(VolumeTaken, ASwollenLayerTakesWhatItWasStretchedTo) {
  for (const float depth : {0.03f, 0.04f, 0.08f, 0.16f})
    for (const float by : {1.2f, 1.5f, 1.8f}) {
      const Vec3f size{0.4f, depth, 0.2f};
      const double by_rest = taken(stretched(test::lattice(h, size, all), by), size, true);
      EXPECT_NEAR(by_rest / static_cast<double>(by), 1, slack + 0.02) << depth << ", " << by;
    }
}

TEST(VolumeTaken, WithoutWallsToo) {
  const Vec3f size{0.4f, 0.16f, 0.2f};
  EXPECT_NEAR(taken(test::lattice(h, size, all), size, false), 1, slack);
  const Vec3f c{0.3f, 0.3f, 0.3f};
  std::vector<Vec3f> ball = test::lattice(h, {0.6f, 0.6f, 0.6f}, [&](const Vec3f& p) { return length(p - c) < 0.1f; });
  EXPECT_NEAR(taken(ball, c, false), 1, slack);
  for (Vec3f& p : ball) p = p * 1.2f;
  EXPECT_NEAR(taken(ball, c, false), 1.728, 1.728 * slack);
}

TEST(VolumeTaken, DropsCountAsAtRest) {
  std::vector<Vec3f> spray;
  for (int i = 0; i < 10; ++i) spray.push_back({0.1f * static_cast<float>(i), 0.5f, 0});
  EXPECT_NEAR(taken(spray, {1, 1, 1}, false), 1, 1e-6);
  SurfaceInput none;
  none.spacing = h;
  EXPECT_EQ(volume_taken(none), 0);
}

TEST(VolumeTaken, TooFewToFillAKernelCountAsAtRest) {
  for (const bool walled : {false, true})
    for (const float jitter : {0.0f, 0.5f}) {
      const Vec3f block{0.03f, 0.03f, 0.03f};
      const std::vector<Vec3f> points = test::lattice(h, block, all, jitter);  // 27
      EXPECT_NEAR(taken(points, {0.3f, 0.3f, 0.3f}, walled), 1, 1e-6) << walled << ", " << jitter;
    }
}

TEST(VolumeTaken, IsTheSameForAnyNumberOfThreads) {
  const Vec3f size{0.2f, 0.1f, 0.2f};
  const auto points = test::lattice(h, size, all);
  double one = 0;
  {
    const ThreadLimit threads(1);
    one = taken(points, size, true);
  }
  const ThreadLimit threads(2);
  EXPECT_EQ(taken(points, size, true), one);
}

}  // namespace
}  // namespace dreampm
