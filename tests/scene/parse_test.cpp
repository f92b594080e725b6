// The meaning of a scene: defaults, presets, variants, overrides.
#include "dreampm/scene/parse.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "dreampm/base/error.h"
#include "dreampm/scene/emit.h"

namespace dreampm::scene {
namespace {

using testing::HasSubstr;

const std::string start = R"(dreampm: 1
name: box
space: {min: [0, 0, 0], max: [1, 1, 1], spacing: 0.02}
materials: {water: {type: newtonian}}
bodies: {pool: {material: water, shape: {box: {min: [0, 0, 0], max: [1, 0.5, 1]}}}}
)";

model::Scene good(const std::string& text, const ParseOptions& options = {}) {
  const ParseResult r = parse_scene_text(text, "scene.yaml", options);
  EXPECT_TRUE(r.ok()) << r.text();
  return r.scene;
}
std::string bad(const std::string& text, const ParseOptions& options = {}) {
  const ParseResult r = parse_scene_text(text, "scene.yaml", options);
  EXPECT_FALSE(r.ok());
  return r.text();
}

TEST(Parse, FillsInEveryDefault) {
  const model::Scene s = good(start);
  EXPECT_EQ(s.output.folder, "out/box");
  EXPECT_EQ(s.time.fps, 24);
  EXPECT_EQ(s.gravity, (Vec3d{0, -9.81, 0}));
  EXPECT_EQ(s.materials[0].values["gamma"], 7);
  EXPECT_FALSE(s.materials[0].values.has("bulk_modulus")) << "is for the solver to derive";
  EXPECT_EQ(s.render.looks.at("water").type, model::LookType::dielectric);
  const BoxShape& box = std::get<BoxShape>(s.bodies[0].shape.form);
  EXPECT_EQ(box.size, (Vec3d{1, 0.5, 1}));
  EXPECT_EQ(*s.bodies[0].shape.center, (Vec3d{0.5, 0.25, 0.5}));
}

TEST(Parse, RoundsTheSpaceUpToWholeCellsOnly) {
  std::string text = start;
  text.replace(text.find("max: [1, 1, 1]"), 14, "max: [1, 1.01, 0.84]");
  const model::Space s = good(text).space;
  EXPECT_EQ(s.cells(), (Vec3i{25, 26, 21})) << "0.84 is 21 cells of 0.04, not 22";
  EXPECT_NEAR(s.end().y, 1.04, 1e-12);
  EXPECT_EQ(s.max.y, 1.01);
}

TEST(Parse, PeriodicAxesAreWholeBlocksWithoutWalls) {
  std::string text = start;
  text.replace(text.find("max: [1, 1, 1], spacing: 0.02"), 29,
               "max: [1, 1, 0.96], spacing: 0.02, periodic: [z, x], walls: {all: {type: stick}}");
  const model::Space s = good(text).space;
  EXPECT_EQ(s.cells(), (Vec3i{28, 25, 24}));
  EXPECT_NEAR(s.end().x, 1.12, 1e-12);
  EXPECT_NEAR(s.end().z, 0.96, 1e-12);
  EXPECT_EQ(s.walls[index(Side::x_min)], (Wall{WallType::open, 0}));
  EXPECT_EQ(s.walls[index(Side::y_max)], (Wall{WallType::stick, 0}));
}

TEST(Parse, WallsGoFromGeneralToSpecial) {
  const std::string walls =
      "walls: {x_min: {type: open}, all: {friction: 0.3, skin_friction: true}, sides: {type: slip}, floor: {type: "
      "stick}, "
      "z_max: {skin_friction: false}}";
  std::string text = start;
  text.replace(text.find("spacing: 0.02"), 13, "spacing: 0.02, " + walls);
  const auto w = good(text).space.walls;
  EXPECT_EQ(w[index(Side::x_min)], (Wall{WallType::open, 0}));
  EXPECT_EQ(w[index(Side::x_max)], (Wall{WallType::slip, 0.3, true}));
  EXPECT_EQ(w[index(Side::z_max)], (Wall{WallType::slip, 0.3, false}));
  EXPECT_EQ(w[index(Side::y_min)], (Wall{WallType::stick, 0}));
  EXPECT_EQ(w[index(Side::y_max)], (Wall{WallType::separate, 0.3, true}));
}

TEST(Parse, SecondsBecomeFrames) {
  EXPECT_EQ(good(start + "time: {fps: 30, seconds: 2.5}").time.frames, 75);
  EXPECT_EQ(good(start + "time: {seconds: 0.1, fps: 30}").time.frames, 3) << "not 4 by rounding";
}

TEST(Parse, PresetFirstThenOwnKeys) {
  std::string text = start;
  text.replace(text.find("type: newtonian"), 15, "viscosity: 8, type: newtonian, preset: honey");
  const model::Scene s = good(text);
  EXPECT_EQ(s.materials[0].values["viscosity"], 8);
  EXPECT_EQ(s.materials[0].values["density"], 1418);
}

TEST(Parse, WordsOfParameters) {
  std::string text = start;
  text.replace(text.find("type: newtonian"), 15, "type: newtonian, gamma: linear, tension: true");
  const model::Scene s = good(text);
  EXPECT_EQ(s.materials[0].values["gamma"], -1);
  EXPECT_EQ(s.materials[0].values["tension"], 1);
}

TEST(Parse, AVariantsFixedStepStandsInsteadOfWhatBoundsTheStep) {
  const std::string text =
      start + "time: {fps: 24, frames: 2, cfl: 0.4, dt_max: 1.0e-3}\nvariants: {fixed: {time: {dt: 2.0e-4}}}\n";
  const model::Scene s = good(text, {.variant = "fixed", .overrides = {}});
  EXPECT_EQ(s.time.dt, 2.0e-4);
  EXPECT_EQ(s.time.dt_max, std::nullopt);
}

TEST(Parse, AParameterThatTakesWordsNamesThem) {
  EXPECT_EQ(bad(start, {.variant = {}, .overrides = {"materials.water.gamma=cubic"}}),
            "--set materials.water.gamma=cubic: error: materials.water.gamma is 'cubic': must be a number or linear\n");
}

const std::string with_variants = start + R"(time: {fps: 24, frames: 100, cfl: 0.4}
variants:
  coarse:
    space: {spacing: 0.05}
    time: {seconds: 2, dt: 1.0e-3}
  stiff:
    materials: {water: {bulk_modulus: 1.0e6}}
  ball:
    bodies: {pool: {shape: {sphere: {radius: 0.2}, center: [0.5, 0.5, 0.5]}}}
  solid:
    materials: {water: {type: elastic}}
)";

TEST(Variants, AreLaidOverTheScene) {
  const model::Scene s = good(with_variants, {.variant = "coarse", .overrides = {}});
  EXPECT_EQ(s.space.spacing, 0.05);
  EXPECT_EQ(s.space.max, (Vec3d{1, 1, 1})) << "the rest of the map stays";
  EXPECT_EQ(s.time.frames, 48) << "seconds stand instead of frames";
  EXPECT_EQ(s.time.dt, 1e-3) << "and dt instead of cfl";
  EXPECT_EQ(s.output.folder, "out/box-coarse");
  EXPECT_EQ(good(with_variants).space.spacing, 0.02) << "the scene itself is untouched";
}

TEST(Variants, AnotherFormOrTypeReplacesTheWhole) {
  const model::Scene ball = good(with_variants, {.variant = "ball", .overrides = {}});
  EXPECT_EQ(std::get<SphereShape>(ball.bodies[0].shape.form).radius, 0.2);
  const model::Scene solid = good(with_variants, {.variant = "solid", .overrides = {}});
  EXPECT_EQ(solid.materials[0].type, "elastic");
  EXPECT_EQ(solid.render.looks.at("water").type, model::LookType::opaque);
}

TEST(Variants, KeepTheirOwnPlaces) {
  const std::string text = start + "variants:\n  preview:\n    space: {spacing: 0}\n";
  EXPECT_EQ(bad(text, {.variant = "preview", .overrides = {}}),
            "scene.yaml:8:22: error: space.spacing is 0: must be above 0 m\n");
}

TEST(Variants, AnUnknownOneNamesTheNearest) {
  EXPECT_EQ(bad(with_variants, {.variant = "corse", .overrides = {}}),
            "scene.yaml: error: no variant 'corse'; did you mean 'coarse'?\n");
  EXPECT_EQ(bad(start, {.variant = "preview", .overrides = {}}), "scene.yaml: error: no variant 'preview'\n");
}

TEST(Overrides, WinOverVariants) {
  const model::Scene s =
      good(with_variants, {.variant = "coarse",
                           .overrides = {"space.spacing=0.1", "time.frames=7", "bodies.pool.velocity=[1, 2, 3]",
                                         "materials.water.max_compression=0.05", "gravity=[0, 0, 0]"}});
  EXPECT_EQ(s.space.spacing, 0.1);
  EXPECT_EQ(s.time.frames, 7);
  EXPECT_EQ(s.bodies[0].velocity, (Vec3d{1, 2, 3}));
  EXPECT_EQ(s.gravity, Vec3d{});
}

TEST(Overrides, AnotherHollowKeepsTheContainer) {
  const std::string text =
      start +
      "colliders: {mold: {shape: {container: {box: {size: [1, 1, 1]}, rotate: {axis: x, angle: 9}, "
      "wall: 0.03, up: [0, -1, 0]}, center: [1, 2, 3]}}}\n";
  const auto container = [&](const std::string& more) {
    const model::Scene s = good(text, {.variant = "", .overrides = {"colliders.mold.shape.container." + more}});
    return std::get<ContainerShape>(s.colliders.at(0).shape.form);
  };
  const ContainerShape ball = container("sphere={radius: 0.4}");
  EXPECT_EQ(std::get<SphereShape>(ball.hollow.at(0).form).radius, 0.4);
  EXPECT_EQ(ball.hollow[0].rotate_angle, 0) << "that was the box's";
  EXPECT_EQ(ball.wall, 0.03);
  EXPECT_EQ(ball.up, (Vec3d{0, -1, 0}));
  EXPECT_EQ(container("wall=0.5").hollow.at(0).rotate_angle, 9);
  EXPECT_EQ(container("cut=0.5").cut, 0.5);
}

TEST(Overrides, OneThatBeginsNoYamlIsRefused) {
  EXPECT_THAT(bad(start, {.variant = "", .overrides = {"time.fps=,"}}),
              HasSubstr("--set time.fps=,: error: not valid YAML: nothing may begin so"));
}

TEST(Overrides, AreNamedInTheirErrors) {
  EXPECT_EQ(
      bad(start, {.variant = "", .overrides = {"space.spacing=5 mm", "time.fsp=3", "dreampm=2", "nonsense", "a..b=1"}}),
      "--set dreampm=2: error: dreampm cannot be set\n"
      "--set nonsense: error: must read PATH=VALUE, as in space.spacing=0.01\n"
      "--set a..b=1: error: an empty name in the path\n"
      "--set space.spacing=5 mm: error: space.spacing is '5 mm': must be a number without a unit, in SI: write "
      "0.005\n"
      "--set time.fsp=3: error: unknown key 'time.fsp'; did you mean 'fps'?\n");
}

TEST(Parse, AKeyOfYaml11ThatWasReadAsTrueIsNamed) {
  EXPECT_THAT(
      bad(start + "probes: {push: {type: force, true: floor}}\n"),
      HasSubstr("unknown key 'probes.push.true': YAML 1.1 takes a bare `on` for true; put it in quotes: \"on\""));
}

TEST(Parse, MoreMaterialsThanFilesNumberAreRefused) {
  std::string many = "materials: {";
  for (int m = 0; m < 257; ++m) many += fmt::format("m{}: {{type: newtonian}}, ", m);
  const std::string text = start.substr(0, start.find("materials")) + many + "water: {type: newtonian}}\n" +
                           start.substr(start.find("bodies"));
  EXPECT_THAT(bad(text), HasSubstr("materials: 258 are named; at most 256"));
}

TEST(Parse, CollidersAreGreyUnlessTheyHaveALook) {
  const std::string text = std::string(start) +
                           "colliders: {post: {shape: {sphere: {radius: 0.1}, center: [0.5, 0.8, 0.5]}}, bed: {shape: "
                           "{sphere: {radius: 0.1}, center: [0.2, 0.8, 0.5]}}}\n"
                           "render: {looks: {bed: {type: opaque, color: [1, 0, 0]}}}\n";
  const model::Scene d = good(text);
  EXPECT_EQ(d.render.looks.at("post").type, model::LookType::opaque);
  EXPECT_NEAR(d.render.looks.at("post").color.x, d.render.looks.at("post").color.z, 0.05);
  EXPECT_EQ(d.render.looks.at("bed").color, (Vec3d{1, 0, 0}));
}

TEST(Parse, ALookHasWhatItsTypeIsKnownFor) {
  const std::string text = std::string(start) +
                           "colliders: {crate: {shape: {box: {size: [0.1, 0.1, 0.1]}, center: [0.5, 0.8, 0.5]}}, gate: "
                           "{shape: {sphere: {radius: 0.1}, center: [0.2, 0.8, 0.5]}}}\n"
                           "render: {cut: {point: [0, 0, 0.5], normal: [0, 0, 2], of: [crate, water]}, "
                           "looks: {crate: {type: wood}, gate: {type: metal, color: [1, 0.8, 0.3]}}}\n";
  const model::Scene d = good(text);
  const model::Look &crate = d.render.looks.at("crate"), &gate = d.render.looks.at("gate");
  EXPECT_EQ(crate.type, model::LookType::wood);
  EXPECT_GT(crate.color.x, crate.color.z + 0.2) << "brown";
  EXPECT_LT(crate.roughness, 1);
  EXPECT_FALSE(crate.ring || crate.grain);
  EXPECT_EQ(gate.color, (Vec3d{1, 0.8, 0.3})) << "what is given stays";
  EXPECT_LT(gate.roughness, 0.5);
  ASSERT_TRUE(d.render.cut);
  EXPECT_EQ(d.render.cut->of, (std::vector<std::string>{"crate", "water"}));
  EXPECT_FALSE(good(std::string(start)).render.cut);
}

TEST(Parse, HoneyAndSnowLookLikeThemselvesAndPresetsOfLooksGiveWayToKeys) {
  const std::string text =
      std::string(start.substr(0, start.find("materials"))) +
      "materials: {water: {type: newtonian}, honey: {type: newtonian, preset: honey}, snow: {type: "
      "snow}, jelly: {type: elastic, preset: jelly}}\n" +
      start.substr(start.find("bodies")) + "render: {looks: {water: {preset: milk, absorption: [1, 2, 3]}}}\n";
  const model::Scene d = good(text);
  const auto& looks = d.render.looks;
  EXPECT_NEAR(looks.at("honey").ior, 1.49, 0.02);
  EXPECT_GT(looks.at("snow").scattering.x, 100);
  EXPECT_EQ(looks.at("jelly").type, model::LookType::opaque) << "matte, in the colors of its bodies";
  EXPECT_EQ(looks.at("water").scattering, (Vec3d{2550, 3210, 3770}));
  EXPECT_EQ(looks.at("water").absorption, (Vec3d{1, 2, 3}));
  EXPECT_EQ(good(write_scene(d)).render, d.render) << "what is written is read as the same";
  EXPECT_THAT(bad(start + "render: {looks: {water: {preset: mlik}}}\n"), HasSubstr("milk"));
  EXPECT_THAT(bad(start + "render: {looks: {water: {type: opaque, scattering: [1, 1, 1]}}}\n"),
              HasSubstr("scattering is only for type dielectric"));
}

TEST(Parse, APresetOrATypeOfAVariantReplacesWhatItIsLaidOver) {
  const auto look = [](const char* base, const char* over) {
    const std::string text =
        fmt::format("{}render: {{looks: {{water: {}}}}}\nvariants: {{v: {{render: {{looks: {{water: {}}}}}}}}}\n",
                    start, base, over);
    return good(text, {.variant = "v", .overrides = {}}).render.looks.at("water");
  };
  const model::Look paint = look("{preset: milk, anisotropy: 0.5}", "{type: opaque, color: [1, 0, 0]}");
  EXPECT_EQ(paint.type, model::LookType::opaque);
  EXPECT_EQ(paint.scattering, Vec3d{});
  EXPECT_EQ(paint.color, (Vec3d{1, 0, 0}));
  EXPECT_EQ(look("{type: opaque, color: [1, 0, 0]}", "{preset: milk}").scattering.x, 2550);
  EXPECT_EQ(look("{preset: milk}", "{anisotropy: 0.5}").scattering.x, 2550) << "keys beside a preset change it";
}

TEST(Parse, APlaceBringsItsSkyAndAnEnvironmentNoSun) {
  const auto light = [](const std::string& render) { return good(start + "render: " + render + "\n").render.light; };
  EXPECT_EQ(light("{}").sky, SkyKind::clear);
  EXPECT_EQ(light("{}").sun.strength, 8);
  EXPECT_EQ(light("{stage: {place: studio}}").sky, SkyKind::studio);
  EXPECT_EQ(light("{stage: {place: studio}}").sun.strength, 0);
  EXPECT_EQ(light("{stage: {place: night}, light: {sun: {strength: 3}}}").sun.strength, 3);
  EXPECT_EQ(light("{stage: {place: night}, light: {sky: clear}}").sun.strength, 8);
  const std::string file = ::testing::TempDir() + "around.exr";
  std::ofstream(file) << "read when it is drawn";
  const model::Light around = light("{light: {environment: " + file + ", turn: 30}}");
  EXPECT_EQ(around.environment, file);
  EXPECT_EQ(around.turn, 30);
  EXPECT_EQ(around.sun.strength, 0);
  const model::Scene night =
      good(start + "render: {light: {sky: night}}\nvariants: {v: {render: {light: {environment: " + file + "}}}}\n",
           {.variant = "v", .overrides = {}});
  EXPECT_EQ(night.render.light.environment, file) << "in place of the sky";
  EXPECT_EQ(good(write_scene(night)).render.light, night.render.light);
  EXPECT_THAT(bad(start + "render: {light: {environment: nowhere.exr}}\n"),
              HasSubstr("render.light.environment is 'nowhere.exr': no such file"));
}

TEST(Parse, AFileThatIsNotThere) {
  const ParseResult r = parse_scene("no/such/scene.yaml");
  EXPECT_FALSE(r.ok());
  EXPECT_THAT(r.text(), HasSubstr("no/such/scene.yaml"));
  EXPECT_THROW(load_scene("no/such/scene.yaml"), InputError);
}

TEST(Parse, HostileTextIsRefusedQuickly) {
  EXPECT_THAT(bad(std::string("a\0b", 3)), HasSubstr("not a text file"));
  EXPECT_THAT(bad("a: &a [*a]\n"), HasSubstr("deeply"));
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    std::string refs;
    for (int k = 0; k < 10; ++k) refs += fmt::format("{}*a{}", k ? ", " : "", i - 1);
    bomb += fmt::format("a{0}: &a{0} [{1}]\n", i, refs);
  }
  EXPECT_THAT(bad(bomb), HasSubstr("more than"));
  EXPECT_FALSE(parse_scene_text(std::string(100000, '['), "x.yaml").ok());
  // yaml-cpp takes nothing of it, and would begin a document there for ever.
  for (const char* text : {",", " }", "# a\n]", "[a] ,"}) EXPECT_FALSE(parse_scene_text(text, "x.yaml").ok()) << text;
  EXPECT_THAT(bad(","), HasSubstr("scene.yaml:1:1: error: not valid YAML: nothing may begin so"));
  std::string list = "a: [";
  for (int i = 0; i < 300000; ++i) list += "1,";
  EXPECT_THAT(bad(list + "1]"), HasSubstr("more than 100000 values"));
}

TEST(Parse, ManyProblemsAndVariantsTakeTimeInProportion) {
  std::string text = start, variants = start + "variants:\n";
  for (int i = 0; i < 50000; ++i) text += fmt::format("k{}: 1\n", i);
  for (int i = 0; i < 20000; ++i) variants += fmt::format("  v{}: {{}}\n", i);
  const std::string all = bad(text);
  EXPECT_THAT(all, HasSubstr("scene.yaml: error: more than 1000 problems; the first are listed\n"));
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 1001);
  EXPECT_THAT(bad(variants), HasSubstr("20000 variants of 200"));
  EXPECT_THAT(bad(start + "? " + std::string(200000, 'x') + "\n: 1\n"), HasSubstr("unknown key"));
}

TEST(EditDistance, CountsEdits) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("spacing", "spaceing"), 1);
  EXPECT_EQ(edit_distance("fps", "fsp"), 1) << "a swap is one edit";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

}  // namespace
}  // namespace dreampm::scene
