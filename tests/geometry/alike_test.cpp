#include "dreampm/geometry/alike.h"

#include "meshes.h"

using namespace dreampm;

namespace {

/// The mesh with each face turned for which `turned(its number)`.
template <class Turned>
Model with_turned(const TriMesh& mesh, const Turned& turned) {
  Model model = model_of(mesh);
  for (std::size_t f = 0; f < model.triangles.size(); ++f)
    if (turned(f)) std::swap(model.triangles[f][1], model.triangles[f][2]);
  return model;
}

TEST(Alike, FacesThatDifferAreTurnedOutward) {
  const TriMesh ball = sphere_mesh(1, 2, {3, 0, 0});
  const double volume = enclosed_volume(model_of(ball));
  for (const std::size_t every : {2u, 3u, 7u}) {  // turned are more than half, fewer, one in seven
    Model model = with_turned(ball, [&](std::size_t f) { return f % every != 1; });
    std::size_t wrong = 0;
    for (std::size_t f = 0; f < model.triangles.size(); ++f) wrong += f % every != 1;
    const Alike found = turn_alike(model);
    EXPECT_EQ(found.turned, wrong);
    EXPECT_EQ(found.parts, 1u);
    EXPECT_NEAR(enclosed_volume(model), volume, 1e-12);
  }
}

TEST(Alike, PartsThatAgreeStayAsTheyAre) {
  const TriMesh outer = sphere_mesh(1, 2), inner = sphere_mesh(0.5, 2);
  const std::size_t first = outer.triangles.size();
  // A hollow: the inner wall looks inward.
  Model hollow = with_turned(joined(outer, inner), [&](std::size_t f) { return f >= first; });
  const auto triangles = hollow.triangles;
  EXPECT_EQ(turn_alike(hollow).turned, 0u);
  EXPECT_EQ(hollow.triangles, triangles);
  // One face of that wall is wrong: it is that one, not all the others.
  std::swap(hollow.triangles[first + 9][1], hollow.triangles[first + 9][2]);
  const Alike found = turn_alike(hollow);
  EXPECT_EQ(found.turned, 1u);
  EXPECT_EQ(found.parts, 2u);
  EXPECT_EQ(hollow.triangles, triangles);
}

TEST(Alike, EveryHollowOfManyKeepsItsInnerWall) {
  // 12 x 12 x 4 hollow balls, side by side, and a wrong face in each of the walls.
  TriMesh all;
  const TriMesh outer = sphere_mesh(0.4, 0), inner = sphere_mesh(0.2, 0);
  for (int i = 0; i < 576; ++i) {
    const Vec3d at{i / 48 + 0.0, i / 4 % 12 + 0.01 * i, i % 4 + 0.0};
    for (const TriMesh* wall : {&outer, &inner}) {
      TriMesh moved = *wall;
      for (auto& v : moved.vertices) v = Vec3f(Vec3d(v) + at);
      if (wall == &inner)
        for (auto& t : moved.triangles) std::swap(t[1], t[2]);
      all = joined(std::move(all), moved);
    }
  }
  const Model right = model_of(all);
  Model model = right;
  for (std::size_t f = 3; f < model.triangles.size(); f += 8) std::swap(model.triangles[f][1], model.triangles[f][2]);
  const Alike found = turn_alike(model);
  EXPECT_EQ(found.parts, 1152u);
  EXPECT_EQ(found.turned, 1152u);
  EXPECT_TRUE(model.triangles == right.triangles);
}

TEST(Alike, CornersOfTheirOwnCountAsOneVertex) {
  const TriMesh ball = sphere_mesh(1, 1);
  Model soup;
  for (const auto& t : ball.triangles) {
    for (const std::uint32_t v : t) soup.vertices.push_back(Vec3d(ball.vertices[v]));
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  std::swap(soup.triangles[5][0], soup.triangles[5][1]);
  EXPECT_EQ(turn_alike(soup).turned, 1u);
  EXPECT_NEAR(enclosed_volume(soup), enclosed_volume(model_of(ball)), 1e-12);
}

TEST(Alike, OneSidedAndCrowdedMeshesAreReported) {
  Model strip;  // of five quads, closed with half a twist
  for (int i = 0; i < 5; ++i) {
    const double a = 2 * M_PI * i / 5, b = M_PI * i / 5;
    for (const double w : {-0.3, 0.3})
      strip.vertices.push_back(
          {std::cos(a) * (1 + w * std::cos(b)), w * std::sin(b), std::sin(a) * (1 + w * std::cos(b))});
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, c = i < 4 ? a + 2 : 1, d = i < 4 ? a + 3 : 0;
    strip.triangles.push_back({a, b, d});
    strip.triangles.push_back({a, d, c});
  }
  const auto before = strip.triangles;
  turn_alike_with_warnings(strip, "strip.ply");
  EXPECT_EQ(strip.triangles, before);
  ASSERT_EQ(strip.warnings.size(), 1u);
  EXPECT_NE(strip.warnings[0].find("strip.ply: 1 of its parts have only one side"), std::string::npos);

  Model fin = model_of(sphere_mesh(1, 1));  // with a third face on an edge
  fin.vertices.push_back({2, 2, 2});
  fin.triangles.push_back(
      {fin.triangles[0][0], fin.triangles[0][1], static_cast<std::uint32_t>(fin.vertices.size() - 1)});
  EXPECT_EQ(turn_alike(fin).crowded_edges, 1u);
  // Two boxes that touch at an edge are none of that kind: as many faces one way as the other.
  Model twice = model_of(joined(sphere_mesh(1, 1), sphere_mesh(1, 1)));
  EXPECT_EQ(turn_alike(twice).crowded_edges, 0u);
  EXPECT_EQ(turn_alike(twice).turned, 0u);
}

}  // namespace
