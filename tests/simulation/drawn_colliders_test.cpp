// Colliders of a picture: the frame of their grain and the cut, where a body has moved.
#include <gtest/gtest.h>

#include <numbers>

#include "dreampm/pictures/render_scene.h"
#include "dreampm/scene/parse.h"

namespace dreampm {
namespace {

model::Scene with_crate(const std::string& render) {
  const scene::ParseResult r = scene::parse_scene_text(
      "dreampm: 1\nname: x\nspace: {min: [0, 0, 0], max: [1, 1, 1], spacing: 0.05}\n"
      "materials: {water: {type: newtonian}}\n"
      "bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [1, 0.2, 1]}}}}\n"
      "rigid: {crate: {shape: {box: {size: [0.4, 0.1, 0.2]}}, density: 400, position: [0.5, 0.5, 0.5]}}\n"
      "render: " +
          render + "\n",
      "x.yaml");
  EXPECT_TRUE(r.ok()) << r.text();
  return r.scene;
}

/// A quarter turn about y that leaves the crate's middle where it is.
Pose turned() {
  const Quaternion q = Quaternion::about({0, 0.5 * std::numbers::pi, 0});
  const Vec3d middle{0.5, 0.5, 0.5};
  return {middle - q(middle), q};
}

TEST(DrawnColliders, TheGrainGoesWithTheBody) {
  const model::Scene scene = with_crate("{looks: {crate: {type: wood, ring: 0.01}}}");
  const ColliderModels models(scene, {0.1, 0.1, 0.1});
  const std::vector<Pose> rest{Pose{}}, poses{turned()};
  const DrawnColliders before = models.at(rest, 0), after = models.at(poses, 0);
  const TextureFrame &a = before.objects.at(0).frame, &b = after.objects.at(0).frame;
  EXPECT_NEAR(std::fabs(a.x.x), 1, 1e-5) << "along the longest side";
  EXPECT_NEAR(std::fabs(b.x.z), 1, 1e-5);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.middle[k], 0.4f, 1e-5f) << "from the shift on";
    EXPECT_NEAR(b.middle[k], 0.4f, 1e-5f);
  }
  EXPECT_EQ(after.objects.at(0).look.ring, 0.01);
}

TEST(DrawnColliders, ThePlaneOfTheCutStaysWhereItIs) {
  const model::Scene scene =
      with_crate("{cut: {point: [0.6, 0, 0], normal: [2, 0, 0], of: [crate]}, looks: {crate: {type: wood}}}");
  const ColliderModels models(scene, {0.1, 0.1, 0.1});
  const auto reach = [&](const Pose& pose) {
    Box3f box;
    const DrawnColliders drawn = models.at(std::vector<Pose>{pose}, 0);
    for (const Vec3f& v : drawn.meshes.front().vertices) box.add(v);
    return box;
  };
  EXPECT_NEAR(reach(Pose{}).max.x, 0.5f, 1e-5f) << "cut";
  EXPECT_NEAR(reach(Pose{}).min.x, 0.2f, 1e-5f);
  EXPECT_NEAR(reach(turned()).max.x, 0.5f, 1e-5f) << "turned, it ends at the plane";
  const Pose away{{1, 0, 0}, {}};
  EXPECT_TRUE(models.at(std::vector<Pose>{away}, 0).objects.empty()) << "all of it is before the plane";
}

TEST(DrawnColliders, OnlyWhatIsNamedIsCut) {
  const model::Scene scene = with_crate("{cut: {point: [0.6, 0, 0], normal: [1, 0, 0], of: [water]}}");
  EXPECT_FALSE(cut_of(scene, "crate", {}));
  ASSERT_TRUE(cut_of(scene, "water", {0.1, 0, 0}));
  EXPECT_NEAR(cut_of(scene, "water", {0.1, 0, 0})->point.x, 0.5, 1e-12);
}

}  // namespace
}  // namespace dreampm
