// Holes of a mesh, counted and measured.
#include "dreampm/geometry/openness.h"

#include <gtest/gtest.h>

#include "meshes.h"

namespace dreampm::openness_test {
namespace {

TEST(Openness, AClosedMeshHasNoHoles) {
  const TriMesh ball = sphere_mesh(0.5, 4);
  const Openness o = openness(ball);
  EXPECT_EQ(o.edges, ball.triangles.size() * 3 / 2);  // Euler: every edge has two triangles
  EXPECT_EQ(o.open_edges, 0u);
  EXPECT_EQ(o.holes, 0u);
  EXPECT_EQ(o.widest, 0);
}

TEST(Openness, HolesAreCountedAndMeasured) {
  const TriMesh one = with_hole(sphere_mesh(0.5, 5), {0, 0.5, 0}, 0.2);
  const TriMesh two = with_hole(one, {0.5, 0, 0}, 0.1);
  const Openness o = openness(two);
  EXPECT_EQ(o.holes, 2u);
  EXPECT_GT(o.open_edges, 20u);
  EXPECT_NEAR(o.widest, 0.4, 0.06);  // within two edges of the mesh
  EXPECT_EQ(openness(one).holes, 1u);
}

TEST(Openness, TrianglesWithVerticesOfTheirOwnAreJoinedByPlace) {
  const TriMesh ball = sphere_mesh(1, 3);
  TriMesh soup;
  for (const auto& t : ball.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(ball.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(openness(soup).open_edges, 0u);
  soup.triangles.pop_back();
  EXPECT_EQ(openness(soup).open_edges, 3u);
}

TEST(Openness, HalfASphereIsOneHoleAsWideAsItself) {
  TriMesh half = sphere_mesh(1, 4);
  std::erase_if(half.triangles, [&](const auto& t) {
    return half.vertices[t[0]].y + half.vertices[t[1]].y + half.vertices[t[2]].y > 0;
  });
  const Openness o = openness(half);
  EXPECT_EQ(o.holes, 1u);
  EXPECT_NEAR(o.widest, 2, 1e-5);
}

}  // namespace
}  // namespace dreampm::openness_test
