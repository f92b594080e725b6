// Colliders as they are drawn, compared with their shapes.
#include "dreampm/setup/collider_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "dreampm/geometry/openness.h"
#include "dreampm/pictures/render_scene.h"
#include "dreampm/surface/attributes.h"

namespace dreampm {
namespace {

const Box3d room{{0, 0, 0}, {1, 1, 1}};

Shape shape(const decltype(Shape::form)& form, const Vec3d& center) {
  Shape s;
  s.form = form, s.center = center;
  return s;
}

Box3d bounds_of(const TriMesh& mesh) {
  Box3d b;
  for (const Vec3f& v : mesh.vertices) b.add(static_cast<Vec3d>(v));
  return b;
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "axis " << k;
}

TEST(ColliderMesh, PrimitivesAreClosedAndHoldTheirVolume) {
  const TriMesh box = collider_mesh(shape(BoxShape{{0.2, 0.3, 0.4}}, {0.5, 0.5, 0.5}), 0.02, room);
  EXPECT_EQ(openness(box).open_edges, 0u);
  EXPECT_NEAR(surface::enclosed_volume(box), 0.024, 1e-7);  // positive: faces look outward
  const TriMesh ball = collider_mesh(shape(SphereShape{0.2}, {0.5, 0.5, 0.5}), 0.02, room);
  EXPECT_EQ(openness(ball).open_edges, 0u);
  // A polyhedron within the ball: 96 meridians and 48 rows lose (2 pi / 96)^2 / 2 or so.
  EXPECT_NEAR(surface::enclosed_volume(ball) / (4.0 / 3 * std::numbers::pi * 0.008), 1, 3e-3);
  const TriMesh tube = collider_mesh(shape(CylinderShape{0.1, 0.5}, {0.5, 0.5, 0.5}), 0.02, room);
  EXPECT_EQ(openness(tube).open_edges, 0u);
  EXPECT_NEAR(surface::enclosed_volume(tube) / (std::numbers::pi * 0.01 * 0.5), 1, 1e-3);
}

TEST(ColliderMesh, AContainerIsOpenAtItsMouth) {
  ContainerShape cup;
  cup.hollow = {shape(SphereShape{0.2}, {0, 0, 0})};
  cup.wall = 0.02, cup.cut = 0.2;
  const double bowl = 2.0 / 3 * std::numbers::pi * 0.008, outer = 2.0 / 3 * std::numbers::pi * 0.22 * 0.22 * 0.22;
  const TriMesh block = collider_mesh(shape(cup, {0.5, 0.5, 0.5}), 0.01, room);
  EXPECT_EQ(openness(block).open_edges, 0u);
  EXPECT_NEAR(surface::enclosed_volume(block) / (0.44 * 0.44 * 0.22 - bowl), 1, 0.02);
  expect_near(bounds_of(block).max, {0.72, 0.61, 0.72}, 0.01);
  cup.form = ContainerShape::Form::shell;
  const TriMesh shell = collider_mesh(shape(cup, {0.5, 0.5, 0.5}), 0.05, room);
  EXPECT_EQ(openness(shell).open_edges, 0u);
  EXPECT_NEAR(surface::enclosed_volume(shell) / (outer - bowl), 1, 0.06) << "though the wall is thinner than a voxel";
}

TEST(ColliderMesh, CountsFromTheShift) {
  const Vec3d shift{524288, 0, -16384};
  Shape turned = shape(BoxShape{{0.2, 0.1, 0.4}}, {0.5, 0.5, 0.5});
  turned.rotate_axis = {1, 2, 3}, turned.rotate_angle = 30;
  const Shape ball = shape(SphereShape{0.25}, {0.5, 0.5, 0.5});
  const Shape knot = shape(MeshShape{"asset:knot", 0.5, {}}, {0.5, 0.5, 0.5});
  Shape cut;
  cut.form = BooleanShape{BooleanShape::Op::difference, {turned, ball}};
  Shape plane;
  plane.form = PlaneShape{{0, 0.5, 0}, {1, 1, 0.5}};
  for (const Shape& near : {turned, ball, cut, plane, knot}) {
    const std::function<void(Shape&)> move = [&](Shape& s) {
      if (s.center) *s.center += shift;
      if (PlaneShape* p = std::get_if<PlaneShape>(&s.form)) p->point += shift;
      if (BooleanShape* b = std::get_if<BooleanShape>(&s.form))
        for (Shape& part : b->parts) move(part);
    };
    Shape far = near;
    move(far);
    const TriMesh a = collider_mesh(near, 0.02, room),
                  b = collider_mesh(far, 0.02, {room.min + shift, room.max + shift}, shift);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    for (std::size_t v = 0; v < a.vertices.size(); ++v) expect_near(Vec3d(a.vertices[v]), Vec3d(b.vertices[v]), 1e-6);
  }
}

TEST(ColliderMesh, IsTurnedAboutItsCenterAndPut) {
  Shape s = shape(BoxShape{{0.2, 0.1, 0.4}}, {0.4, 0.5, 0.6});
  s.rotate_axis = {0, 0, 1}, s.rotate_angle = 90;
  const Box3d b = bounds_of(collider_mesh(s, 0.02, room));
  expect_near(b.min, {0.35, 0.4, 0.4}, 1e-6);
  expect_near(b.max, {0.45, 0.6, 0.8}, 1e-6);
}

TEST(ColliderMesh, APlaneIsCutToTheRoom) {
  Shape s;
  s.form = PlaneShape{{0, 0.5, 0}, {1, 1, 0}};  // x + y = 1/2
  const TriMesh plane = collider_mesh(s, 0.02, room);
  const Box3d b = bounds_of(plane);
  expect_near(b.min, {0, 0, 0}, 3e-4);
  expect_near(b.max, {0.5, 0.5, 1}, 3e-4);
  double area = 0;
  for (const auto& t : plane.triangles)
    area += 0.5 * length(cross(Vec3d(plane.vertices[t[1]] - plane.vertices[t[0]]),
                               Vec3d(plane.vertices[t[2]] - plane.vertices[t[0]])));
  EXPECT_NEAR(area, std::sqrt(0.5), 1e-3);
  s.form = PlaneShape{{0, -1, 0}, {0, 1, 0}};
  EXPECT_TRUE(collider_mesh(s, 0.02, room).triangles.empty());
}

TEST(ColliderMesh, ADifferenceIsContoured) {
  BooleanShape dish;
  dish.op = BooleanShape::Op::difference;
  dish.parts = {shape(BoxShape{{0.6, 0.4, 0.6}}, {0.5, 0.4, 0.5}), shape(SphereShape{0.2}, {0.5, 0.6, 0.5})};
  Shape s;
  s.form = dish;
  const double voxel = 0.02;
  const TriMesh mesh = collider_mesh(s, voxel, room);
  EXPECT_EQ(openness(mesh).open_edges, 0u);
  const double volume = 0.144 - 2.0 / 3 * std::numbers::pi * 0.008;
  // Bevels take about a quarter of voxel^2 along the edges, 7.2 m of them.
  EXPECT_NEAR(surface::enclosed_volume(mesh), volume, 7.2 * voxel * voxel * 0.5);
  expect_near(bounds_of(mesh).max, {0.8, 0.6, 0.8}, 1e-3);
}

TEST(ColliderMesh, AShellIsDrawnHollow) {
  const double radius = 0.2, thickness = 0.02;
  const TriMesh hollow = collider_mesh(shape(SphereShape{radius}, {0.5, 0.5, 0.5}), 0.02, room, {}, thickness);
  EXPECT_EQ(openness(hollow).open_edges, 0u);
  const auto ball = [](double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; };
  const double volume = ball(radius + thickness / 2) - ball(radius - thickness / 2);
  EXPECT_NEAR(surface::enclosed_volume(hollow) / volume, 1, 0.02);
  expect_near(bounds_of(hollow).max, Vec3d{0.5, 0.5, 0.5} + Vec3d{1, 1, 1} * (radius + thickness / 2), 1e-3);
  // A plane becomes a plate, closed at the sides.
  Shape plane;
  plane.form = PlaneShape{{0, 0.5, 0}, {0, 1, 0}};
  const TriMesh plate = collider_mesh(plane, 0.05, room, {}, 0.1);
  EXPECT_EQ(openness(plate).open_edges, 0u);
  EXPECT_NEAR(surface::enclosed_volume(plate), 0.1, 0.01);
}

TEST(ColliderMesh, StaysAHairOffFloorAndGlass) {
  const Box3d b = bounds_of(collider_mesh(shape(BoxShape{{0.2, 0.2, 1}}, {0.1, 0.1, 0.5}), 0.02, room));
  EXPECT_GT(b.min.x, 0);
  EXPECT_GT(b.min.y, 0);
  EXPECT_LT(b.max.z, 1);
  expect_near(b.min, {0, 0, 0}, 1e-3);
}

TEST(ColliderMesh, ClearOnesStandOnTheFloor) {
  // Without a film of air, which would mirror.
  const Shape box = shape(BoxShape{{0.2, 0.2, 1}}, {0.5, 0.103, 0.5});
  const Box3d b = bounds_of(collider_mesh(box, 0.02, room, {}, {}, true));
  EXPECT_EQ(b.min.y, 0);
  EXPECT_EQ(b.min.z, 0);
  EXPECT_EQ(b.max.z, 1);
  EXPECT_NEAR(b.max.y, 0.203, 1e-6);
  EXPECT_NEAR(bounds_of(collider_mesh(box, 0.02, room)).min.y, 0.003, 1e-6);
}

TEST(Colors, OfABodyLieOnItsHalfOfTheMesh) {
  // Two bodies of one material, red at the left, blue at the right; a vertex in each and one far
  // off.
  std::vector<Vec3f> positions, colors;
  const Vec3f red{1, 0, 0}, blue{0, 0, 1};
  for (int i = 0; i < 20; ++i) {
    positions.push_back({0.01f * static_cast<float>(i), 0, 0});
    colors.push_back(i < 10 ? red : blue);
  }
  TriMesh mesh;
  mesh.vertices = {{0.02f, 0.005f, 0}, {0.17f, 0.005f, 0}, {0.095f, 0.005f, 0}, {1, 1, 1}};
  const std::vector<Vec3f> got = vertex_colors(mesh, positions, colors, 0.01f, Mixing::opaque);
  EXPECT_EQ(got[0], red);
  EXPECT_EQ(got[1], blue);
  PigmentMix half(Mixing::opaque);  // half way
  half.add(Pigment::of(red, Mixing::opaque), 1), half.add(Pigment::of(blue, Mixing::opaque), 1);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[2][c], half.color()[c], 1e-3f);
  EXPECT_EQ(got[3], blue);  // the nearest
}

}  // namespace
}  // namespace dreampm
