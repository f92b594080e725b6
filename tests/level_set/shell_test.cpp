// Walls of a given thickness about surfaces that enclose nothing.
#include "dreampm/level_set/shell.h"

#include <cmath>
#include <random>

#include "geometry/meshes.h"

namespace dreampm::shell_test {
namespace {

constexpr double thickness = 0.01, voxel = thickness / 3, reach = 0.03;

/// The lower half of a ball, open at the top, as one layer of faces.
TriMesh open_bowl(double radius, int times = 5) {
  TriMesh mesh = sphere_mesh(radius, times);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return mesh.vertices[t[0]].y + mesh.vertices[t[1]].y + mesh.vertices[t[2]].y > 1e-6f;
  });
  return mesh;
}

/// Returns the places where the line from `from` along `to` enters and leaves the region, from its
/// distances alone.
std::pair<double, double> crossed(const Region& region, const Vec3d& from, const Vec3d& along, double length) {
  double enter = -1, leave = -1;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double t = length * i / steps;
    const bool inside = region.distance(from + along * t) < 0;
    if (inside && enter < 0) enter = t;
    if (inside) leave = t;
  }
  return {enter, leave};
}

std::string obj(const TriMesh& mesh) {
  std::string text;
  for (const Vec3f& v : mesh.vertices)
    text += "v " + std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
  for (const auto& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' + std::to_string(t[2] + 1) + '\n';
  return text;
}

TEST(Shell, AnOpenBowlHasAWallOfItsThickness) {
  constexpr double radius = 0.1;
  const auto shell = mesh_shell(model_of(open_bowl(radius)), 1, thickness, voxel, reach, "bowl");
  std::mt19937 dice(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    Vec3d ray = normalized(Vec3d{normal(dice), -std::abs(normal(dice)), normal(dice)});
    if (ray.y > -0.1) continue;
    const auto [enter, leave] = crossed(*shell, {}, ray, 0.14);
    ASSERT_GT(enter, 0) << "a hole at " << ray.x << ' ' << ray.y << ' ' << ray.z;
    EXPECT_NEAR(leave - enter, thickness, 0.1 * thickness);
    EXPECT_NEAR(0.5 * (leave + enter), radius, 0.05 * thickness);
    EXPECT_GT(shell->distance(ray * (radius - 0.75 * thickness)), 0);
    EXPECT_GT(shell->distance(ray * (radius + 0.75 * thickness)), 0);
    EXPECT_NEAR(shell->distance(ray * (radius - 0.02)), 0.02 - thickness / 2, 0.03 * thickness);
    EXPECT_GT(dot(shell->normal(ray * (radius + thickness / 2)), ray), 0.99);
    EXPECT_LT(dot(shell->normal(ray * (radius - thickness / 2)), ray), -0.99);
  }
  EXPECT_GT(shell->distance({0, 0.05, 0}), 0.02) << "no cap at the top";
  EXPECT_NEAR(shell->bounds().min.y, -radius - thickness / 2, 1e-6);
}

TEST(Shell, ASheetIsAPlate) {
  TriMesh sheet;
  sheet.vertices = {{0, 0, 0}, {0.2f, 0, 0}, {0.2f, 0, 0.2f}, {0, 0, 0.2f}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  // At any place between the voxels.
  for (const double y : {0.0, 0.0007, 0.0016, 0.0024}) {
    TriMesh moved = sheet;
    for (Vec3f& v : moved.vertices) v.y += static_cast<float>(y);
    // The middle of the bounds is a voxel; a speck far off keeps it from moving along.
    moved.vertices.insert(moved.vertices.end(), {{0.1f, 0.1f, 0.1f}, {0.1f, 0.1f, 0.101f}, {0.101f, 0.1f, 0.1f}});
    moved.triangles.push_back({4, 5, 6});
    const auto plate = mesh_shell(model_of(moved), 1, thickness, voxel, reach, "sheet");
    const auto [enter, leave] = crossed(*plate, {0.06, y - 0.02, 0.12}, {0, 1, 0}, 0.04);
    EXPECT_NEAR(leave - enter, thickness, 0.02 * thickness) << y;
  }
}

TEST(Shell, PrimitivesAndCombinationsAreHollow) {
  const Meshes meshes(Meshes::Say::keep);
  Shape ball;
  ball.form = SphereShape{0.1};
  ball.center = Vec3d{1, 2, 3};
  const auto hollow = shell_region(ball, thickness, voxel, reach, meshes);
  EXPECT_NEAR(hollow->distance({1, 2, 3}), 0.1 - thickness / 2, 1e-12);
  EXPECT_NEAR(hollow->distance({1.1, 2, 3}), -thickness / 2, 1e-12);
  EXPECT_NEAR(hollow->distance({1.2, 2, 3}), 0.1 - thickness / 2, 1e-12);
  EXPECT_NEAR(dot(hollow->normal({1.097, 2, 3}), {-1, 0, 0}), 1, 1e-9);
  EXPECT_NEAR(hollow->bounds().max.x, 1.1 + thickness / 2, 1e-12);

  Shape both, box;
  box.form = BoxShape{{0.2, 0.2, 0.2}};
  box.center = Vec3d{1.2, 2, 3};
  both.form = BooleanShape{BooleanShape::Op::unite, {ball, box}};
  const auto joint = shell_region(both, thickness, voxel, reach, meshes);
  EXPECT_GT(joint->distance({1, 2, 3}), 0);
  EXPECT_GT(joint->distance({1.2, 2, 3}), 0);
  EXPECT_LT(joint->distance({1.3, 2, 3}), 0);
}

TEST_F(InFolder, ShellsOfFilesDoNotSpeakOfHoles) {
  Shape shape;
  shape.form = MeshShape{file("bowl.obj", obj(open_bowl(0.1, 4))).string(), {}, 2.0};
  shape.center = Vec3d{0.5, 0.5, 0.5};
  const Meshes meshes(Meshes::Say::keep);
  const auto shell = shell_region(shape, thickness, voxel, reach, meshes);
  EXPECT_TRUE(meshes.warnings().empty()) << meshes.warnings()[0];
  // The bowl is 0.2 deep, and its bounds' middle lies at the center.
  EXPECT_NEAR(shell->distance({0.5, 0.4, 0.5}), -thickness / 2, 0.1 * thickness);
  EXPECT_GT(shell->distance({0.5, 0.45, 0.5}), 0.02);
  meshes.regions()(std::get<MeshShape>(shape.form), 0.01, 0);
  ASSERT_EQ(meshes.warnings().size(), 1u);
  EXPECT_NE(meshes.warnings()[0].find("not closed"), std::string::npos);
}

/// A hollow ball whose wall is as thick as a voxel.
TEST_F(InFolder, ThinWallsAreSampledFiner) {
  TriMesh inner = sphere_mesh(0.09, 4);
  for (auto& t : inner.triangles) std::swap(t[0], t[1]);
  const MeshShape hollow{file("hollow.obj", obj(joined(sphere_mesh(0.1, 4), inner))).string(), {}, {}},
      full{file("full.obj", obj(sphere_mesh(0.1, 4))).string(), {}, {}};
  const Meshes meshes(Meshes::Say::keep);
  const auto wall = meshes.fine_regions()(hollow, 0.01, 0);
  std::mt19937 dice(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const auto [enter, leave] = crossed(*wall, {}, normalized(Vec3d{normal(dice), normal(dice), normal(dice)}), 0.12);
    EXPECT_NEAR(leave - enter, 0.01, 0.001);
  }
  EXPECT_NEAR(wall->distance({}), 0.03, 1e-6) << "as far as others";
  EXPECT_EQ(meshes.fine_regions()(full, 0.01, 0), meshes.regions()(full, 0.01, 0)) << "the same region";
}

TEST(Shell, RefusesWhatTakesTooMuchMemory) {
  const std::string said = refusal([] { mesh_shell(model_of(open_bowl(10)), 1, 0.001, 0.001 / 3, 0.03, "big"); });
  EXPECT_NE(said.find("big: a shell 0.001 m thick about 6"), std::string::npos) << said;
  EXPECT_NE(said.find(" GiB"), std::string::npos) << said;
}

}  // namespace
}  // namespace dreampm::shell_test
