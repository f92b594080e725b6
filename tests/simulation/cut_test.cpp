// Bodies that leave out what lies inside of colliders and rigid bodies: `cut`.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"
#include "dreampm/setup/assemble.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
using testing::HasSubstr;
using testing::ThrowsMessage;

model::Scene pool(const std::string& body, const std::string& more) {
  const auto parsed = scene::parse_scene_text(
      "dreampm: 1\nname: pool\nspace: {max: [0.4, 0.3, 0.2], spacing: 0.01}\ntime: {fps: 50, frames: 10}\n"
      "materials: {water: {type: newtonian}}\nbodies:\n  pool: {material: water, " +
          body + "}\n" + more,
      "pool.yaml");
  EXPECT_TRUE(parsed.ok()) << parsed.text();
  return parsed.scene;
}
InitialState made(const std::string& body, const std::string& more) { return assemble(pool(body, more), "pool.yaml"); }
const std::string block = "shape: {box: {min: [0, 0, 0], max: [0.4, 0.1, 0.2]}}";
const std::string post = "{box: {min: [0.1, -0.1, 0.05], max: [0.15, 0.2, 0.15]}}";
const std::string paddle = "{sphere: {radius: 0.045}, center: [0.3, 0.06, 0.1]}";

// The same points as where the shapes are written a second time.
TEST(Cut, IsTheDifferenceOfTheShapes) {
  const std::string solids = "colliders: {post: {shape: " + post + "}, paddle: {shape: " + paddle + "}}\n";
  const InitialState cut = made(block + ", cut: [post, paddle]", solids),
                     difference = made("shape: {difference: [{box: {min: [0, 0, 0], max: [0.4, 0.1, 0.2]}}, " + post +
                                           ", " + paddle + "]}",
                                       solids);
  ASSERT_EQ(cut.particles(), difference.particles());
  EXPECT_NEAR(double(cut.particles()), 8000 - 500 - 380, 30);
  // Their jitter is drawn in the order in which places are filled.
  const auto cells = [](const InitialState& all) {
    std::set<std::array<int, 3>> places;
    for (const ParticleSeed& s : all.seeds[0])
      places.insert({int(s.position.x / 0.01), int(s.position.y / 0.01), int(s.position.z / 0.01)});
    return places;
  };
  EXPECT_EQ(cells(cut), cells(difference));
  for (const ParticleSeed& s : cut.seeds[0])
    for (const Collider& c : cut.world.colliders) EXPECT_GE(c.distance(s.position), 0);
  std::uint32_t id = 0;
  for (const ParticleSeed& s : cut.seeds[0]) EXPECT_EQ(s.id, id++) << "none is left out";
  EXPECT_TRUE(cut.warnings.empty()) << cut.warnings[0];
}

TEST(Cut, TakesRigidBodiesContainersAndShellsAsTheyStandAtTheStart) {
  const InitialState all = made(
      block + ", cut: [crate, cup, shell, gate]",
      "colliders:\n"
      "  cup: {shape: {container: {box: {size: [0.06, 0.04, 0.06]}, wall: 0.02, cut: 0}, center: [0.1, 0.05, 0.1]}}\n"
      "  shell: {shape: {sphere: {radius: 0.04}, center: [0.2, 0.05, 0.1]}, thickness: 0.02}\n"
      "  gate: {shape: {box: {size: [0.02, 0.3, 0.2]}, center: [0, 0.1, 0.1]}, motion: {keys: [{t: 0, position: [0.28, "
      "0, 0]}, {t: 1, position: [0.3, 0, 0]}]}}\n"
      "rigid: {crate: {shape: {box: {size: [0.06, 0.06, 0.06]}}, density: 400, position: [0.35, 0.08, 0.1]}}\n");
  const auto at = [&](const Vec3d& place) {
    return std::any_of(all.seeds[0].begin(), all.seeds[0].end(),
                       [&](const ParticleSeed& s) { return length(s.position - place) < 0.009; });
  };
  EXPECT_TRUE(at({0.1, 0.05, 0.1})) << "the hollow of the cup is no part of it";
  EXPECT_TRUE(at({0.2, 0.05, 0.1})) << "nor that of the shell";
  EXPECT_FALSE(at({0.28, 0.05, 0.1})) << "where its motion begins";
  EXPECT_TRUE(at({0.005, 0.05, 0.1}));
  EXPECT_FALSE(at({0.35, 0.08, 0.1}));
  for (const ParticleSeed& s : all.seeds[0])
    for (const Collider& c : all.world.colliders) ASSERT_GT(c.distance(s.position), -1e-6) << c.name;
}

TEST(Cut, LeavesMatterOfOthersAlone) {
  const std::string held =
      "  core: {material: water, shape: {box: {min: [0.11, 0.02, 0.06], max: [0.14, 0.08, 0.14]}}}\n"
      "colliders: {post: {shape: " +
      post + ", holds: true}}\n";
  EXPECT_TRUE(made(block + ", cut: [post]", held).warnings.empty());
  EXPECT_THAT(made(block, held).warnings.at(0), HasSubstr("bodies pool and core overlap"));
}

TEST(Cut, IsNamedWhereMatterLiesInASolid) {
  EXPECT_THAT([] { made(block, "colliders: {post: {shape: " + post + "}}\n"); },
              ThrowsMessage<InputError>(HasSubstr("cut it out of the body with cut: [post], or say holds: true")));
  EXPECT_THAT(
      [] {
        made(block + ", cut: [post]", "colliders: {post: {shape: " + post + "}, paddle: {shape: " + paddle + "}}\n");
      },
      ThrowsMessage<InputError>(HasSubstr("cut it out of the body with cut: [post, paddle],")));
}

TEST(Cut, OfAllOfABodyIsRefused) {
  EXPECT_THAT(
      [] { made(block + ", cut: [rock]", "colliders: {rock: {shape: {box: {min: [-1, -1, -1], max: [1, 1, 1]}}}}\n"); },
      ThrowsMessage<InputError>(
          HasSubstr("pool.yaml:7:3: error: body pool lies wholly inside of what is cut out of it")));
}

TEST(Cut, IsKeptInASceneAndGoesWithItsCollider) {
  const std::string solids = "colliders: {post: {shape: " + post + "}, paddle: {shape: " + paddle + "}}\n";
  const model::Scene there = pool(block + ", cut: [post, paddle]", solids);
  const auto again = scene::parse_scene_text(scene::write_scene(there), "again.yaml");
  ASSERT_TRUE(again.ok()) << again.text();
  EXPECT_EQ(again.scene.bodies[0].cut, (std::vector<std::string>{"post", "paddle"}));
  EXPECT_NE(scene::scene_hash(there, scene::Part::simulation),
            scene::scene_hash(pool(block + ", cut: [post]", solids), scene::Part::simulation));
  Simulation s(Scene(there, "pool.yaml"), quiet());
  s.remove_collider("paddle");
  s.remove(Shape::box({0, 0, 0}, {0.05, 0.3, 0.2}));
  s.set_gravity({0, -1, 0});
  EXPECT_EQ(s.scene().model().bodies[0].cut, std::vector<std::string>{"post"});
  s.step();
}

}  // namespace
}  // namespace dreampm
