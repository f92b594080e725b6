// Scenes that programs build are held to the rules of scene files.
#include "dreampm/scene/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/scene/emit.h"
#include "dreampm/scene/parse.h"

namespace dreampm::scene {
namespace {
using testing::HasSubstr;

/// A scene with one of each.
model::Scene of_each() {
  model::Scene s;
  s.name = "each";
  s.space.max = {1, 1, 1}, s.space.spacing = 0.02;
  s.materials = {{"water"}, {"jelly", "elastic", {{"youngs_modulus", 1e5}}}};
  s.materials[1].transfer = "flip", s.materials[1].transfer_values = {{"flip_blend", 0.9}};
  s.bodies = {{"drop", "water", Shape::sphere({0.5, 0.8, 0.5}, 0.1)},
              {"cube", "jelly", Shape::box({0.1, 0.1, 0.1}, {0.3, 0.3, 0.3})}};
  s.colliders = {{"post", Shape::cylinder({0.5, 0.2, 0.5}, 0.1, 0.2) - Shape::sphere({0.5, 0.3, 0.5}, 0.08)},
                 {.name = "crate", .shape = Shape::box({0.7, 0.7, 0.7}, {0.8, 0.8, 0.8}), .rigid = model::Rigid{400.0}},
                 {.name = "nail", .shape = Shape::sphere({0.2, 0.2, 0.2}, 0.05), .holds = true, .pin = true}};
  s.emitters = {{.name = "tap",
                 .material = "water",
                 .shape = Shape::sphere({0.2, 0.9, 0.2}, 0.05),
                 .velocity = Vec3d{0, -1, 0},
                 .pool = 100}};
  s.sinks = {{"drain", Shape::box({0.4, 0, 0.4}, {0.6, 0.05, 0.6})}};
  s.fields = {{"gust", "wind", {}, {{"velocity", {3, 0, 0}}}}};
  s.fields[0].type = "drag", s.fields[0].numbers = {{"rate", 2}};
  s.probes = {{"push", 0, ForceProbe{"floor"}},
              {"track", 0, PoseProbe{"crate"}},
              {"come", 0, InflowProbe{"tap"}},
              {"wide", 0, ExtentProbe{0, "water"}},
              {"point", 0, PointProbe{"cube", {0.2, 0.2, 0.2}}}};
  s.render.looks["crate"] = model::Look::wood();
  return s;
}

std::string problem_of(const model::Scene& scene) {
  const ParseResult r = check_scene(scene);
  return r.ok() ? "" : r.text();
}

TEST(Check, ASceneOfEachIsRightAndReadsBackFromItsFile) {
  const ParseResult r = check_scene(of_each());
  ASSERT_TRUE(r.ok()) << r.text();
  EXPECT_EQ(r.scene.materials[0].values["gamma"], 7) << "what is left out has its default";
  EXPECT_EQ(r.scene.output.folder, "out/each");
  EXPECT_EQ(r.scene.render.looks.size(), 2u + 3u) << "all have a look";
  const std::string text = write_scene(r.scene);
  const ParseResult again = parse_scene_text(text, "each.yaml");
  ASSERT_TRUE(again.ok()) << again.text();
  EXPECT_EQ(write_scene(again.scene), text);
}

TEST(Check, ScenesOfFilesAreRightAsModelsAndStayAsTheyAre) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(DM_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    const ParseResult file = parse_scene(entry.path());
    ASSERT_TRUE(file.ok()) << file.text();
    const ParseResult r = check_scene(file.scene);
    EXPECT_TRUE(r.ok()) << entry.path() << ": " << r.text();
    EXPECT_EQ(write_scene(r.scene), write_scene(file.scene)) << entry.path();
    EXPECT_EQ(scene_hash(r.scene, Part::video), scene_hash(file.scene, Part::video)) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 10u);
}

TEST(Check, EveryWrongMemberIsNamedByItsPath) {
  using Change = std::function<void(model::Scene&)>;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<Change, std::string>> wrong{
      {[](auto& s) { s.name = "a b"; }, "name is 'a b'"},
      {[](auto& s) { s.space.spacing = 0; }, "space.spacing is 0: must be above 0 m"},
      {[](auto& s) { s.space.max.y = -1; }, "space.max[1] is -1: must be above space.min[1]"},
      {[](auto& s) { s.space.walls[0] = {WallType::stick, 0.5}; }, "space.walls.x_min.friction is only for type"},
      {[](auto& s) { s.time.fps = 0; }, "time.fps is 0: must be between"},
      {[=](auto& s) { s.gravity.x = nan; }, "gravity[0] is 'nan': must be a finite number"},
      {[](auto& s) { s.materials.clear(); }, "missing key 'materials'"},
      {[](auto& s) { s.materials[0].type = "newtonan"; }, "did you mean 'newtonian'"},
      {[](auto& s) { s.materials[0].values.set("viscosty", 1); }, "unknown key 'materials.water.viscosty'"},
      {[](auto& s) { s.materials[0].values.set("viscosity", -1); }, "materials.water.viscosity is -1: must be"},
      {[=](auto& s) { s.materials[0].values.set("density", nan); }, "materials.water.density is 'nan'"},
      {[](auto& s) { s.materials[0].transfer = "flop"; }, "materials.water.transfer is 'flop'"},
      {[](auto& s) { s.materials[0].transfer_values.set("flip_blend", 1); }, "flip_blend is only for transfer flip"},
      {[](auto& s) { s.materials[1].transfer_values.set("flip_blend", 2); }, "materials.jelly.flip_blend is 2"},
      {[](auto& s) { s.bodies[0].material = "watr"; },
       "bodies.drop.material: no material 'watr'; did you mean 'water'"},
      {[](auto& s) { s.bodies[0].shape = Shape::sphere({}, -1); }, "bodies.drop.shape.sphere.radius is -1"},
      {[](auto& s) { s.colliders[0].shape.form = ContainerShape{}; }, "colliders.post.shape.container has no hollow"},
      {[](auto& s) { s.colliders[0].shape.form = BooleanShape{}; }, "colliders.post.shape.union has 0 shapes"},
      {[](auto& s) { s.colliders[0].sequence = {{"a.ply"}, 24, 1}; }, "colliders.post.shape.meshes has 1 files"},
      {[](auto& s) { s.bodies[0].shape.center.reset(); }, "missing key 'bodies.drop.shape.center'"},
      {[](auto& s) { s.bodies[0].shape = Shape::plane({}, {0, 1, 0}); }, "a body must end somewhere"},
      {[](auto& s) { s.bodies[0].color = Vec3d{2, 0, 0}; }, "bodies.drop.color[0] is 2: must be between 0 and 1"},
      {[](auto& s) { s.bodies[0].cut = {"pst"}; }, "no collider or rigid body 'pst'; did you mean 'post'"},
      {[](auto& s) { s.bodies[1].name = "drop"; }, "bodies: two have the name 'drop'"},
      {[](auto& s) { s.colliders[0].friction = -1; }, "colliders.post.friction is -1"},
      {[](auto& s) { s.colliders[0].name = "water"; }, "looks go by name"},
      {[](auto& s) { s.colliders[0].motion.emplace().keys = {{1}, {0.5}}; }, "keys must follow in time"},
      {[](auto& s) {
         s.colliders[0].motion.emplace().keys = {{1}};
         s.colliders[0].motion->spin = {1, 0, 0};
       },
       "colliders.post.motion.spin is only for motions without keys"},
      {[](auto& s) { s.colliders[1].rigid->mass = 1; }, "rigid.crate: give either a density or a mass"},
      {[](auto& s) { s.colliders[1].motion.emplace(); }, "rigid.crate.motion is only for colliders"},
      {[](auto& s) { s.colliders[2].friction = 1; }, "pins.nail.friction is only for colliders"},
      {[](auto& s) { s.emitters[0].flow = {{0, 1}}; }, "emitters.tap: give either a velocity or a flow"},
      {[](auto& s) { s.emitters[0].pool = 0; }, "emitters.tap.pool is 0"},
      {[](auto& s) { s.sinks[0].shape = Shape::plane({}, {0, 1, 0}); }, "is a plane, which has no end"},
      {[](auto& s) { s.fields[0].type = "wnd"; }, "fields.gust.type is 'wnd'"},
      {[](auto& s) { s.fields[0].numbers.set("rat", 1); }, "unknown key 'fields.gust.rat'"},
      {[](auto& s) { s.probes[0].form = ForceProbe{"flor"}; }, "probes.push.on: no wall or collider 'flor'"},
      {[](auto& s) { s.probes[4].form = PointProbe{"cub", {}}; }, "no body 'cub'; did you mean 'cube'"},
      {[](auto& s) { s.output.attributes = {"pressur"}; }, "did you mean 'pressure'"},
      {[](auto& s) { s.render.looks["crate"].roughness = 2; }, "render.looks.crate.roughness is 2"},
      {[](auto& s) { s.render.looks["post"].roughness = 0.5; }, "render.looks.post.roughness is only for type opaque"},
      {[](auto& s) { s.render.looks["pst"] = {}; }, "no material, collider or rigid body 'pst'"},
      {[](auto& s) { s.render.width = 33; }, "render.size[0] is 33: must be even"},
      {[](auto& s) { s.video.quality = 99; }, "video.quality is 99"},
  };
  for (const auto& [change, text] : wrong) {
    model::Scene scene = of_each();
    change(scene);
    EXPECT_THAT(problem_of(scene), HasSubstr(text));
  }
}

// A model names files; whether they are there is seen where they are read.
TEST(Check, ReadsNoFile) {
  model::Scene scene = of_each();
  scene.colliders[0].shape = Shape::mesh("no/such/file.ply");
  EXPECT_EQ(problem_of(scene), "");
}

TEST(Check, EveryKeyOfTheTablesHasAMeaning) {
  EXPECT_EQ(meaning_of("space.spacing"), "The distance between particles. It sets the resolution of everything.");
  EXPECT_NE(meaning_of("bodies.velocity"), "");
  EXPECT_NE(meaning_of("colliders.motion.keys.position"), "");
  EXPECT_NE(meaning_of("render.light.sun.angle"), "");
  EXPECT_EQ(meaning_of("space.spacng"), "");
}

TEST(Check, PartsOfTextAreReadAlone) {
  EXPECT_EQ(std::get<SphereShape>(parse_shape_text("{sphere: {radius: 0.1}, center: [0, 1, 0]}", "s").form).radius,
            0.1);
  EXPECT_EQ(parse_material_text("{type: newtonian, preset: honey}", "m").values["density"], 1418);
  EXPECT_EQ(parse_look_text("{type: metal}", "l").roughness, 0.3);
  EXPECT_THAT([] { parse_shape_text("{spher: {radius: 0.1}}", "s"); },
              testing::ThrowsMessage<InputError>(HasSubstr("sphere")));
  EXPECT_THAT([] { parse_material_text("{type: newtonian, viscosity: -1}", "m"); },
              testing::ThrowsMessage<InputError>(HasSubstr("viscosity")));
}

}  // namespace
}  // namespace dreampm::scene
