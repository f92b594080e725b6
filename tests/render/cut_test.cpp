// A cut mesh is closed, and holds what was behind the plane.
#include "dreampm/render/cut.h"

#include <gtest/gtest.h>

#include "dreampm/render/texture_frame.h"
#include "shapes.h"

namespace dreampm {
namespace {

double volume(const TriMesh& m) {
  double sum = 0;
  for (const auto& [i, j, k] : m.triangles)
    sum += dot(static_cast<Vec3d>(m.vertices[i]),
               cross(static_cast<Vec3d>(m.vertices[j]), static_cast<Vec3d>(m.vertices[k]))) /
           6;
  return sum;
}

/// The sum of the faces' areas as vectors: zero for a closed mesh.
Vec3d openness(const TriMesh& m) {
  Vec3d sum{};
  for (const auto& [i, j, k] : m.triangles)
    sum += static_cast<Vec3d>(cross(m.vertices[j] - m.vertices[i], m.vertices[k] - m.vertices[i])) * 0.5;
  return sum;
}

TriMesh joined(TriMesh a, const TriMesh& b, bool turned) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto [i, j, k] : b.triangles) {
    if (turned) std::swap(j, k);
    a.triangles.push_back({first + i, first + j, first + k});
  }
  return a;
}

void expect_closed(const TriMesh& m) {
  const Vec3d open = openness(m);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(open[k], 0, 1e-5);
}

TEST(Cut, ABoxLosesWhatIsBeforeThePlane) {
  TriMesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  std::vector<Vec3f> none;
  cut_mesh(box, none, {{0.5, 0.5, 1}, {0, 0, 1}});
  EXPECT_NEAR(volume(box), 2, 1e-5);
  expect_closed(box);
  for (const Vec3f& v : box.vertices) EXPECT_LE(v.z, 1 + 1e-6f);
  cut_mesh(box, none, {{0.5, 1, 0.5}, normalized(Vec3d{1, 1, 0})});
  EXPECT_NEAR(volume(box), 1, 1e-5);
  expect_closed(box);
}

TEST(Cut, WhatIsAllBehindStaysAndAllBeforeGoes) {
  const TriMesh whole = box_mesh({0, 0, 0}, {1, 1, 1});
  TriMesh box = whole;
  std::vector<Vec3f> none;
  cut_mesh(box, none, {{0, 0, 2}, {0, 0, 1}});
  EXPECT_EQ(box.vertices, whole.vertices);
  EXPECT_EQ(box.triangles, whole.triangles);
  cut_mesh(box, none, {{0, 0, 1}, {0, 0, 1}});
  EXPECT_NEAR(volume(box), 1, 1e-6) << "a face on the plane";
  cut_mesh(box, none, {{0, 0, 2}, {0, 0, -1}});
  EXPECT_TRUE(box.triangles.empty());
  EXPECT_TRUE(box.vertices.empty());
}

TEST(Cut, AHollowStaysHollow) {
  const TriMesh shell = joined(ball_mesh({}, 1, 48), ball_mesh({0.1f, 0, 0}, 0.7f, 48), true);
  const double whole = volume(shell);
  for (const Vec3d& n : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, normalized(Vec3d{-0.3, 0.5, 0.8})}) {
    TriMesh front = shell, back = shell;
    std::vector<Vec3f> none;
    cut_mesh(front, none, {{0.013, 0.21, 0.17}, n});
    cut_mesh(back, none, {{0.013, 0.21, 0.17}, -n});
    EXPECT_NEAR(volume(front) + volume(back), whole, 1e-4);
    EXPECT_GT(volume(front), 0.2 * whole);
    expect_closed(front);
    expect_closed(back);
  }
}

TEST(Cut, BodiesThatOverlapAreOneSolid) {
  TriMesh two = joined(box_mesh({0, 0, 0}, {2, 1, 1}), box_mesh({1, 0, 0}, {3, 1, 1}), false);
  std::vector<Vec3f> none;
  cut_mesh(two, none, {{0, 0, 0.5}, {0, 0, 1}});
  double face = 0;
  for (const auto& [i, j, k] : two.triangles) {
    const Vec3f n = cross(two.vertices[j] - two.vertices[i], two.vertices[k] - two.vertices[i]) * 0.5f;
    if (std::fabs(two.vertices[i].z - 0.5f) < 1e-6f && std::fabs(two.vertices[j].z - 0.5f) < 1e-6f &&
        std::fabs(two.vertices[k].z - 0.5f) < 1e-6f)
      face += n.z;
  }
  EXPECT_NEAR(face, 3, 1e-5) << "neither a hole nor twice where they overlap";
}

TEST(Cut, ColorsAndNormalsAreCutToo) {
  TriMesh ball = ball_mesh({}, 1, 24);
  ball.normals = ball.vertices;
  std::vector<Vec3f> colors;
  for (const Vec3f& v : ball.vertices) colors.push_back(Vec3f{0.5f, 0.5f, 0.5f} + v * 0.5f);
  cut_mesh(ball, colors, {{0, 0, 0.3}, {0, 0, 1}});
  ASSERT_EQ(colors.size(), ball.vertices.size());
  ASSERT_EQ(ball.normals.size(), ball.vertices.size());
  for (std::size_t v = 0; v < colors.size(); ++v)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(colors[v][k], 0.5f + 0.5f * ball.vertices[v][k], 1e-5f);
}

TEST(Cut, PointsGoWithTheirColors) {
  std::vector<Vec3f> points{{0, 0, 0}, {0, 0, 1}, {0, 0, -1}}, colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cut_points(points, {&colors}, {{0, 0, 0.5}, {0, 0, 1}});
  EXPECT_EQ(points, (std::vector<Vec3f>{{0, 0, 0}, {0, 0, -1}}));
  EXPECT_EQ(colors, (std::vector<Vec3f>{{1, 0, 0}, {0, 0, 1}}));
}

TEST(Cut, ACutFaceOfGlassLetsLightThrough) {
  // Clear matter stays clear: before a white sky the cut ball is as invisible as the whole one.
  TriMesh ball = ball_mesh({}, 1, 48);
  std::vector<Vec3f> none;
  cut_mesh(ball, none, {{0, 0, 0.2}, {0, 0.3, 1}});
  const Vec3f mean =
      mean_of(render(before_uniform_sky({&ball, model::Look::dielectric(1.5, {})}, 25), small_picture(32, 32, 16)));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], 1, 0.012f);
}

TEST(TextureFrame, LiesAlongTheLongestWay) {
  // A plank that is turned.
  TriMesh plank = box_mesh({-0.3f, -0.02f, -0.08f}, {0.3f, 0.02f, 0.08f});
  const float c = std::cos(0.4f), s = std::sin(0.4f);
  for (Vec3f& v : plank.vertices) v = {1 + c * v.x + s * v.z, 2 + v.y, c * v.z - s * v.x};
  const TextureFrame f = texture_frame(plank, {});
  EXPECT_NEAR(std::fabs(dot(f.x, Vec3f{c, 0, -s})), 1, 1e-4f);
  EXPECT_NEAR(std::fabs(f.z.y), 1, 1e-4f) << "the thinnest";
  EXPECT_NEAR(f.half.x, 0.3f, 1e-4f);
  EXPECT_NEAR(f.half.y, 0.08f, 1e-4f);
  EXPECT_NEAR(f.half.z, 0.02f, 1e-4f);
  EXPECT_NEAR(f.middle.x, 1, 1e-4f);
  const TextureFrame given = texture_frame(plank, Vec3f{0, 0, 2});
  EXPECT_NEAR(given.x.z, 1, 1e-6f);
  EXPECT_NEAR(dot(given.x, given.y), 0, 1e-6f);
  EXPECT_NEAR(dot(cross(given.x, given.y), given.z), 1, 1e-5f);
}

TEST(TextureFrame, OfABoardLiesInItsPlane) {
  // Nearly as wide as long: the thin way stands apart from the others, not the long one.
  const TextureFrame f = texture_frame(box_mesh({0, 0, 0}, {2.5f, 0.3f, 3}), {});
  EXPECT_NEAR(std::fabs(f.x.z), 1, 1e-4f);
  EXPECT_NEAR(std::fabs(f.z.y), 1, 1e-4f);
}

TEST(TextureFrame, OfAlikeWaysTakesThePicturesAxes) {
  const TextureFrame cube = texture_frame(box_mesh({0, 0, 0}, {1, 1, 1}), {});
  EXPECT_EQ(cube.x, (Vec3f{1, 0, 0}));
  EXPECT_EQ(cube.z, (Vec3f{0, 0, 1}));
  const TextureFrame post = texture_frame(box_mesh({0, 0, 0}, {1, 3, 1}), {});
  EXPECT_NEAR(std::fabs(post.x.y), 1, 1e-4f);
  const TextureFrame plate = texture_frame(box_mesh({0, 0, 0}, {3, 1, 3}), {});
  EXPECT_NEAR(std::fabs(plate.z.y), 1, 1e-4f);
  EXPECT_NEAR(plate.x.y, 0, 1e-4f);
}

}  // namespace
}  // namespace dreampm
