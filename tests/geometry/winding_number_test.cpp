#include "dreampm/geometry/winding_number.h"

#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/math/rng.h"
#include "meshes.h"

using namespace dreampm;

namespace {

/// The plain sum over all triangles, by the formula of van Oosterom and Strackee.
double exact(const TriMesh& mesh, const Vec3d& p) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = Vec3d(mesh.vertices[t[0]]) - p, b = Vec3d(mesh.vertices[t[1]]) - p,
                c = Vec3d(mesh.vertices[t[2]]) - p;
    sum += 2 * std::atan2(dot(a, cross(b, c)), length(a) * length(b) * length(c) + dot(a, b) * length(c) +
                                                   dot(b, c) * length(a) + dot(c, a) * length(b));
  }
  return sum / (4 * std::numbers::pi);
}

Vec3d random_point(std::uint64_t i, double reach) {
  return Vec3d{uniform(1, 3 * i) - 0.5, uniform(1, 3 * i + 1) - 0.5, uniform(1, 3 * i + 2) - 0.5} * (2 * reach);
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const WindingNumber winding(sphere_mesh(1, 5));
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vec3d p = random_point(i, 1.5);
    if (std::abs(length(p) - 1) < 0.01) continue;
    EXPECT_NEAR(winding(p), length(p) < 1 ? 1 : 0, 0.01) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(WindingNumber, ExpansionFollowsTheExactSumNearHolesAndSheets) {
  const TriMesh holed = with_hole(joined(sphere_mesh(1, 4), sphere_mesh(0.3, 3, {0.9, 0, 0})), {0, 1, 0}, 0.5);
  const WindingNumber winding(holed);
  double worst = 0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Vec3d p = random_point(i, 1.5);
    worst = std::max(worst, std::abs(winding(p) - exact(holed, p)));
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_GT(worst, 1e-6);  // else the far field was never used
}

TEST(WindingNumber, OverlapsCountTwiceAndInvertedFacesNegative) {
  const TriMesh ball = sphere_mesh(1, 4);
  EXPECT_NEAR(WindingNumber(joined(ball, sphere_mesh(1, 4, {0.5, 0, 0})))({0.25, 0, 0}), 2, 0.01);
  TriMesh turned = ball;
  for (auto& t : turned.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(WindingNumber(turned)({0, 0, 0}), -1, 0.01);
  EXPECT_EQ(WindingNumber(TriMesh{})({0, 0, 0}), 0);
}

}  // namespace
