#include "validate/revolve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace dreampm::validate {
namespace {

/// By the divergence theorem: above 0 where triangles go round counter-clockwise seen from outside.
double volume_of(const TriMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int i) { return static_cast<Vec3d>(mesh.vertices[t[static_cast<std::size_t>(i)]]); };
    six += dot(at(0), cross(at(1), at(2)));
  }
  return six / 6;
}

/// Returns the share of a regular polygon of `n` corners in the area of a circle.
double part_of_a_circle(int n) { return n / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi / n); }

TEST(Revolve, ARingHasTheVolumeOfPappus) {
  // A rectangle of 0.2 x 0.5 m, its center 0.4 m from the axis.
  const TriMesh ring = revolved({{0.3, 0}, {0.5, 0}, {0.5, 0.5}, {0.3, 0.5}}, {1, 2, 3}, 64);
  EXPECT_EQ(ring.vertices.size(), 4u * 64);
  EXPECT_EQ(ring.triangles.size(), 8u * 64);
  EXPECT_NEAR(volume_of(ring) / (2 * std::numbers::pi * 0.4 * 0.1 * part_of_a_circle(64)), 1, 1e-5);
}

TEST(Revolve, AProfileThatTouchesTheAxisIsClosedThere) {
  const TriMesh cone = revolved({{0, 0}, {0.3, 0}, {0, 0.6}}, {0, 0, 0}, 48);
  EXPECT_EQ(cone.triangles.size(), 2u * 48) << "a bottom and a side, and nothing along the axis";
  EXPECT_NEAR(volume_of(cone) / (std::numbers::pi * 0.3 * 0.3 * 0.6 / 3 * part_of_a_circle(48)), 1, 1e-5);
}

}  // namespace
}  // namespace dreampm::validate
