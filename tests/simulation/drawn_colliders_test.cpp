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

FrameRecord crate_at(int frame, double time, const Pose& pose) {
  FrameRecord f;
  f.frame = frame, f.time = time;
  f.poses["crate"] = pose;
  return f;
}

TEST(ColliderMotion, ARigidBodyTurnsEvenlyFromFrameToFrame) {
  const model::Scene scene = with_crate("{}");
  const ColliderModels models(scene, {});
  const Vec3d middle{0.5, 0.5, 0.5};
  // From rest a quarter turn about its middle, which goes 0.2 m along x.
  const FrameRecord now = crate_at(2, 0.1, Pose{}),
                    after = crate_at(3, 0.2, {turned().position + Vec3d{0.2, 0, 0}, turned().rotation});
  const ColliderMotion motion = models.motion_about(now, nullptr, &after, 0.1);
  ASSERT_GE(motion.poses.size(), 9u) << "a quarter turn is drawn along chords of less than 0.2 rad";
  ASSERT_EQ(motion.poses.size() % 2, 1u);
  const Pose end = motion.poses.back()[0], start = motion.poses.front()[0];
  EXPECT_NEAR(end(middle).x, 0.6, 1e-12) << "half of the time to the next frame";
  EXPECT_NEAR(start(middle).x, 0.4, 1e-12) << "nothing says where it was before: it came as it goes";
  EXPECT_NEAR(end(middle).z, 0.5, 1e-12);
  const Vec3d along = end.rotation({1, 0, 0});
  EXPECT_NEAR(along.x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(along.z, -std::sqrt(0.5), 1e-12) << "an eighth of a turn about y";
  EXPECT_EQ(motion.poses[motion.poses.size() / 2][0], Pose{});
}

TEST(ColliderMotion, MovingMeshesHaveStepsAndVelocities) {
  const model::Scene scene = with_crate("{}");
  const ColliderModels models(scene, {});
  const FrameRecord before = crate_at(1, 0, Pose{{-0.1, 0, 0}, {}}), now = crate_at(2, 0.1, Pose{}),
                    after = crate_at(3, 0.2, Pose{{0.1, 0, 0}, {}});
  const ColliderMotion motion = models.motion_about(now, &before, &after, 0.05);
  const std::vector<Pose> poses{Pose{}};
  const DrawnColliders drawn = models.at(poses, 0.1, motion), still = models.at(poses, 0.1);
  const TriMesh& mesh = drawn.meshes.front();
  ASSERT_EQ(mesh.velocities.size(), mesh.vertices.size());
  for (const Vec3f& v : mesh.velocities) EXPECT_LT(length(v - Vec3f{1, 0, 0}), 1e-4f);
  ASSERT_EQ(drawn.objects[0].motion.size(), 3u) << "what does not turn goes straight";
  EXPECT_NEAR(drawn.objects[0].motion.back()->vertices[0].x - mesh.vertices[0].x, 0.025, 1e-5);
  EXPECT_TRUE(still.objects[0].motion.empty());
  // What is cut has faces that change as it goes.
  const model::Scene cut = with_crate("{cut: {point: [0.6, 0, 0], normal: [1, 0, 0], of: [crate]}}");
  EXPECT_TRUE(ColliderModels(cut, {}).at(poses, 0.1, motion).objects[0].motion.empty());
}

}  // namespace
}  // namespace dreampm
