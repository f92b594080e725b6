// Scenes of structs, and edits that need no text and no file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "dreampm/backend/registry.h"
#include "dreampm/base/file.h"
#include "scenes.h"

namespace dreampm {
namespace {
using namespace test;
namespace fs = std::filesystem;

/// dam_and_jelly, as structs.
model::Scene same_as_the_file() {
  model::Scene s;
  s.name = "dam";
  s.space.max = {0.24, 0.2, 0.16}, s.space.spacing = 0.02;
  s.time.fps = 50;
  s.materials = {{"water", "newtonian", preset("newtonian", "water")},
                 {"jelly", "neo_hookean", {{"density", 500}, {"youngs_modulus", 2e4}, {"poissons_ratio", 0.3}}}};
  s.bodies = {{"dam", "water", Shape::box({0, 0, 0}, {0.08, 0.12, 0.16}), {0.5, 0, 0}},
              {"cube", "jelly", Shape::box({0.12, 0.04, 0.04}, {0.2, 0.12, 0.12})}};
  return s;
}

TEST(Model, ASceneOfStructsHasTheBitsOfItsFile) {
  const Scene file = dam_and_jelly(), built{same_as_the_file()};
  EXPECT_EQ(built.yaml(), file.yaml());
  Simulation a(file, quiet()), b(built, quiet());
  EXPECT_EQ(a.hash(), b.hash());
  a.advance_steps(20), b.advance_steps(20);
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Model, AWrongSceneIsRefusedByPath) {
  model::Scene wrong = same_as_the_file();
  wrong.bodies[1].material = "jely";
  wrong.space.spacing = -1;
  EXPECT_THAT(check(wrong),
              testing::UnorderedElementsAre("space.spacing is -1: must be above 0 m",
                                            "bodies.cube.material: no material 'jely'; did you mean 'jelly'?"));
  EXPECT_THAT([&] { Scene scene{wrong}; },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("dam: error: space.spacing is -1")));
}

// Gravity of a scene whose mesh was moved, from another folder, and in a scene with names that the
// library once used itself.
TEST(Model, EditsReadNoFile) {
  const fs::path folder = fs::path(DM_BINARY_DIR) / "edits_read_no_file", before = fs::current_path();
  fs::remove_all(folder);
  make_folder(folder);
  replace_file_text(
      folder / "block.off",
      "OFF\n8 12 0\n0 0 0\n.1 0 0\n.1 .1 0\n0 .1 0\n0 0 .1\n.1 0 .1\n.1 .1 .1\n0 .1 .1\n3 0 2 1\n3 0 3 2\n"
      "3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n");
  replace_file_text(folder / "scene.yaml",
                    "dreampm: 1\nname: b\nspace: {max: [0.4, 0.4, 0.2], spacing: 0.02}\n"
                    "materials: {removed: {type: newtonian}}\n"
                    "bodies: {pool: {material: removed, shape: {box: {min: [0, 0, 0], max: [0.2, 0.2, 0.2]}}}}\n"
                    "colliders: {block: {shape: {mesh: block.off, center: [0.3, 0.1, 0.1]}}}\n");
  fs::current_path(folder);
  Simulation s(load_scene("scene.yaml"), quiet());
  s.advance_steps(3);
  fs::current_path(before);
  fs::remove(folder / "block.off");
  s.set_gravity({0, -5, 0}), s.set_parameter("removed", "viscosity", 2), s.set_wall(Side::x_min, {WallType::slip});
  s.add({"drop", "removed", Shape::sphere({0.1, 0.3, 0.1}, 0.05)});
  s.add(model::Collider{"shelf", Shape::box({0.3, 0.3, 0}, {0.4, 0.32, 0.2})});
  EXPECT_GT(s.remove(Shape::box({0, 0, 0}, {0.1, 0.1, 0.1})), 0u);
  s.remove_collider("shelf");
  s.step();
  EXPECT_EQ(s.gravity(), (Vec3d{0, -5, 0}));
}

TEST(Model, AColliderThatComesInMovesAsItSays) {
  for (const std::string& backend : backends_here()) {
    Simulation s(dam_and_jelly(), quiet(1, backend));
    s.advance_to(0.02);
    model::Collider lift{"lift", Shape::box({0.1, 0.17, 0.02}, {0.2, 0.18, 0.14})};
    lift.motion.emplace().velocity = {0, 0.5, 0};
    s.add(lift);
    EXPECT_NEAR(s.collider("lift").pose.position.y, 0.5 * s.time(), 1e-9);
    s.advance_to(0.05);
    EXPECT_NEAR(s.collider("lift").pose.position.y, 0.5 * s.time(), 1e-9);
    EXPECT_EQ(s.collider("lift").twist.velocity.y, 0.5);
  }
}

TEST(Model, AColliderThatComesInTakesMatterOutWhereItSays) {
  Simulation s(dam_and_jelly(), quiet());
  model::Collider drain{"drain", Shape::box({0.2, 0, 0}, {0.24, 0.03, 0.16})};
  drain.deletes = true;
  s.add(drain);
  s.advance_to(0.4);
  EXPECT_GT(s.counts().drained, 10u);
  EXPECT_THAT([&] { s.remove_collider("drain"); }, testing::ThrowsMessage<InputError>(testing::HasSubstr("is a sink")));
}

TEST(Model, AColliderThatIsRefusedChangesNothing) {
  Simulation s(dam_and_jelly(), quiet());
  s.add(model::Collider{.name = "crate",
                        .shape = Shape::box({0.02, 0.14, 0.02}, {0.06, 0.18, 0.06}),
                        .rigid = model::Rigid{.density = 300}});
  s.step();
  const auto before = s.hash();
  const auto refused = [&](const model::Collider& c, const std::string& what) {
    EXPECT_THAT([&] { s.add(c); }, testing::ThrowsMessage<InputError>(testing::HasSubstr(what)));
    EXPECT_EQ(s.hash(), before) << what;
  };
  refused({"stone", Shape::mesh("no/such/file.ply")}, "no/such/file.ply");
  refused({.name = "stone",
           .shape = Shape::mesh("no/such/file.ply", 0.05, {0.1, 0.18, 0.1}),
           .rigid = model::Rigid{.density = 300}},
          "file.ply");
  refused({.name = "nail", .shape = Shape::sphere({0.1, 0.18, 0.1}, 0.01), .holds = true}, "holds the matter");
  refused(
      {.name = "two", .shape = Shape::box({0.03, 0.15, 0.03}, {0.07, 0.19, 0.07}), .rigid = model::Rigid{.density = 1}},
      "starts");
  refused({"wet", Shape::box({0, 0, 0}, {0.05, 0.05, 0.05})}, "particles lie inside of it");
  s.step();
  EXPECT_EQ(s.names().colliders, std::vector<std::string>{"crate"});
}

TEST(Model, WhatAnEditChangedIsInTheModel) {
  Simulation s(dam_and_jelly(), quiet());
  s.set_wall(Side::z_max, {WallType::separate, 0.2, true});
  s.set_parameter("water", "bulk_modulus", 2e5);
  s.set_parameter("water", "max_compression", 0.02);
  s.add(model::Collider{.name = "crate",
                        .shape = Shape::box({0.02, 0.14, 0.02}, {0.06, 0.18, 0.06}),
                        .rigid = model::Rigid{.density = 300}},
        model::Look::plastic());
  const model::Scene& now = s.scene().model();
  EXPECT_EQ(now.space.walls[index(Side::z_max)], (Wall{WallType::separate, 0.2, true}));
  EXPECT_FALSE(now.materials[0].values.has("bulk_modulus")) << "the other way to say it";
  EXPECT_EQ(now.materials[0].values["max_compression"], 0.02);
  EXPECT_EQ(now.colliders.at(0).rigid->density, 300);
  EXPECT_EQ(now.render.looks.at("crate").type, model::LookType::plastic);
  // A file says the same.
  EXPECT_EQ(parse_scene(s.scene().yaml(), "dam.yaml").yaml(), s.scene().yaml());
}

}  // namespace
}  // namespace dreampm
