#include "dreampm/level_set/level_set.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/sample.h"
#include "dreampm/import/import.h"
#include "dreampm/math/rng.h"
#include "geometry/meshes.h"

using namespace dreampm;

namespace {

constexpr double ball_volume = 4.0 / 3 * std::numbers::pi;

TriMesh turned(TriMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  return mesh;
}
double filled(const Region& region, double h) {
  return double(sample_region(region, h, Pattern::jitter, 1).size()) * h * h * h;
}

TEST(LevelSet, BallHasItsDistanceNormalAndVolume) {
  const double h = 0.04;
  const auto ball = mesh_region(sphere_mesh(1, 6, {5, -2, 1}), h, "ball");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Vec3d u =
        normalized(Vec3d{uniform(2, 3 * i) - 0.5, uniform(2, 3 * i + 1) - 0.5, uniform(2, 3 * i + 2) - 0.5});
    const double r = 1 + (uniform(3, i) - 0.5) * 2 * h;
    const Vec3d p = Vec3d{5, -2, 1} + u * r;
    ASSERT_NEAR(ball->distance(p), r - 1, 0.02 * h) << r;
    ASSERT_GT(dot(ball->normal(p), u), 0.999);
  }
  EXPECT_NEAR(ball->distance({5, -2, 1}), -3 * h, 1e-6);  // clamped in the middle
  EXPECT_NEAR(ball->distance({9, 9, 9}), 3 * h, 1e-6);    // and far away
  EXPECT_NEAR(level_set_volume(*ball), ball_volume, 0.002 * ball_volume);
  EXPECT_NEAR(region_volume(*ball, h), ball_volume, 0.002 * ball_volume);
  EXPECT_NEAR(filled(*ball, h), ball_volume, 0.005 * ball_volume);
}

TEST(LevelSet, ManyDistancesAtOnceHaveTheBitsOfOne) {
  const auto ball = mesh_region(sphere_mesh(1, 4, {5, -2, 1}), 0.1, "ball");
  std::array<std::vector<double>, 3> columns;
  for (std::uint64_t i = 0; i < 5000; ++i)
    for (std::uint64_t a = 0; a < 3; ++a)
      columns[a].push_back((a == 0 ? 5 : a == 1 ? -2 : 1) + (i < 4900 ? 3 : 40) * (uniform(4 + a, i) - 0.5));
  columns[0].back() = 1e30, columns[1].back() = -1e30;
  std::vector<double> found(columns[0].size());
  ball->distances({{columns[0].data(), columns[1].data(), columns[2].data()}, found.size()}, found.data());
  std::size_t near = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i], ball->distance({columns[0][i], columns[1][i], columns[2][i]})) << i;
    near += std::abs(found[i]) < 0.29;
  }
  EXPECT_GT(near, 500u);
}

TEST(LevelSet, AHoleOfFiveVoxelsDoesNotLeak) {
  const double h = 0.04;
  const TriMesh mesh = with_hole(sphere_mesh(1, 6), {0, 1, 0}, 2.5 * h);
  const auto holed = mesh_region(mesh, h, "holed");
  EXPECT_NEAR(level_set_volume(*holed), ball_volume, 0.01 * ball_volume);
  EXPECT_NEAR(filled(*holed, h), ball_volume, 0.01 * ball_volume);
  EXPECT_LT(holed->distance({0, 0.9, 0}), 0);
  EXPECT_GT(holed->distance({0, 1.1, 0}), 0);
  EXPECT_NEAR(holed->distance({0, 1.05, 0}), 0.05, 0.5 * h);  // a distance to the cap, not to the rim
}

TEST(LevelSet, AHoleWiderThanTheBandIsCapped) {
  const double h = 0.05;
  const auto bowl = mesh_region(with_hole(sphere_mesh(1, 5), {0, 1, 0}, 0.45), h, "bowl");  // 18 voxels wide
  EXPECT_LT(bowl->distance({0, 0, 0}), 0);
  EXPECT_LT(bowl->distance({0, 0.75, 0}), 0);
  EXPECT_GT(bowl->distance({0, 1.1, 0}), 0);
  EXPECT_NEAR(level_set_volume(*bowl), ball_volume, 0.02 * ball_volume);
}

TEST(LevelSet, LoosePiecesAndOverlapsCountOnce) {
  const double h = 0.05;
  const TriMesh debris = with_hole(sphere_mesh(0.2, 3), {0, 0.2, 0}, 0.15);  // an open scrap inside
  const auto with_debris = mesh_region(joined(sphere_mesh(1, 5), debris), h, "debris");
  EXPECT_NEAR(level_set_volume(*with_debris), ball_volume, 0.01 * ball_volume);
  EXPECT_NEAR(with_debris->distance({0.2, 0, 0}), -3 * h, 0.01 * h);  // its faces are no surface
  const auto twice = mesh_region(joined(sphere_mesh(1, 5), sphere_mesh(1, 5, {1, 0, 0})), h, "overlap");
  const double lens = std::numbers::pi * (4 + 1) * (2 - 1) * (2 - 1) / 12;  // two unit balls, centers 1 apart
  EXPECT_NEAR(level_set_volume(*twice), 2 * ball_volume - lens, 0.01 * ball_volume);
  EXPECT_LT(twice->distance({0.5, 0, 0}), -2 * h);
}

TEST(LevelSet, AHollowBallKeepsItsHollow) {
  const auto hollow = mesh_region(joined(sphere_mesh(1, 5), turned(sphere_mesh(0.5, 4))), 0.04, "hollow");
  EXPECT_GT(hollow->distance({0, 0, 0}), 0);
  EXPECT_NEAR(level_set_volume(*hollow), ball_volume * 7 / 8, 0.01 * ball_volume);
}

TEST(LevelSet, FacesThatLookInwardAreTurned) {
  const auto ball = mesh_region(turned(sphere_mesh(1, 4)), 0.1, "inward");
  EXPECT_LT(ball->distance({0, 0, 0}), 0);
}

TEST(LevelSet, RefusesWhatEnclosesNothing) {
  TriMesh sheet;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j)
      sheet.vertices.push_back({float(i) * 0.1f, 0.01f * float(i * j % 3), float(j) * 0.1f});
  for (std::uint32_t i = 0; i < 10; ++i)
    for (std::uint32_t j = 0; j < 10; ++j) {
      const std::uint32_t a = i * 11 + j;
      sheet.triangles.push_back({a, a + 1, a + 12});
      sheet.triangles.push_back({a, a + 12, a + 11});
    }
  for (const double h : {0.05, 0.02}) {
    const std::string text = refusal([&] { mesh_region(sheet, h, "sheet.ply"); });
    EXPECT_NE(text.find("sheet.ply: encloses nothing"), std::string::npos) << text;
  }
  EXPECT_NE(refusal([&] { mesh_region(TriMesh{}, 0.1, "none"); }).find("no faces"), std::string::npos);
  EXPECT_NE(refusal([&] { mesh_region(sphere_mesh(100, 2), 0.01, "big"); }).find("too large"), std::string::npos);
  EXPECT_NE(refusal([&] { mesh_region(sphere_mesh(0.001, 2), 0.1, "tiny"); }).find("encloses nothing"),
            std::string::npos);
}

TEST(LevelSet, SameForEveryThreadCount) {
  const TriMesh mesh = with_hole(joined(sphere_mesh(1, 5), sphere_mesh(1, 5, {0.7, 0.3, 0})), {0, 1, 0}, 0.2);
  const auto all = mesh_region(mesh, 0.05, "all");
  std::shared_ptr<const Region> one;
  {
    const ThreadLimit limit(1);
    one = mesh_region(mesh, 0.05, "one");
  }
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const Vec3d p{uniform(5, 3 * i) * 3 - 1, uniform(5, 3 * i + 1) * 3 - 1, uniform(5, 3 * i + 2) * 3 - 1};
    ASSERT_EQ(all->distance(p), one->distance(p));
  }
  EXPECT_EQ(level_set_volume(*all), level_set_volume(*one));
}

TEST(LevelSet, FactoryFitsTurnsAndPlacesAMesh) {
  const MeshRegions meshes = mesh_regions();
  Shape knot;
  knot.form = MeshShape{"asset:knot", 0.8, {}};
  knot.center = Vec3d{1, 2, 3};
  const double h = 0.02;
  const auto region = make_region(knot, h, meshes);
  const Box3d box = region->bounds();
  EXPECT_NEAR(std::max({box.size().x, box.size().y, box.size().z}), 0.8, 1e-6);
  EXPECT_NEAR(length(box.center() - Vec3d{1, 2, 3}), 0, 1e-6);
  // the tube of radius 0.34 about the knot's curve, scaled: Pappus' theorem gives its volume
  double curve = 0;
  const auto at = [](double t) {
    const double r = 1 + 0.45 * std::cos(3 * t);
    return Vec3d{r * std::cos(2 * t), 0.6 * std::sin(3 * t), r * std::sin(2 * t)};
  };
  for (int i = 0; i < 10000; ++i)
    curve += length(at(i * 2e-4 * std::numbers::pi) - at((i + 1) * 2e-4 * std::numbers::pi));
  Box3d raw;
  for (const Vec3d& v : load_mesh("asset:knot").vertices) raw.add(v);
  const double s = 0.8 / std::max({raw.size().x, raw.size().y, raw.size().z});
  const double tube = std::numbers::pi * 0.34 * 0.34 * curve * s * s * s;
  EXPECT_NEAR(filled(*region, h), tube, 0.03 * tube);
  Shape standing = knot;
  standing.rotate_axis = {1, 0, 0}, standing.rotate_angle = 90;
  EXPECT_NEAR(make_region(standing, h, meshes)->bounds().size().y, box.size().z, 1e-6);
  EXPECT_THROW(meshes(MeshShape{"asset:knot", -1.0, {}}, h, 0), InputError);
  EXPECT_EQ(meshes(MeshShape{"asset:knot", 0.8, {}}, h, 0), meshes(MeshShape{"asset:knot", 0.8, {}}, h, 0))
      << "not shared";
}

}  // namespace
