// The report's config.yaml, and its presets as scenes.
#include "dreampm/play/report/report_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dreampm/base/file.h"
#include "dreampm/model/scene.h"
#include "dreampm/scene.h"
#include "dreampm/simulation.h"
#include "thrown.h"

namespace dreampm::play::report_config_test {
namespace {
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// As the report prints it.
constexpr std::string_view original = R"(# initial window size
width: 1920
height: 1080

## less particles, num: 8192 (Recommended)
grid number: 32
max timestep: 4
max hard: 4

## more particles, num: 65536 (Unstable)
#grid number: 64
#max timestep: 2
#max hard: 2.5

# you can only change materials' color
materials:
  - id: 0
    name: DIY_MATERIAL
    default color: [ 1.0, 1.0, 1.0, 1.0 ]

  - id: 1
    name: SOLID_CUBE
    default color: [ 0.93, 0.33, 0.23, 1.0 ]

# set any preset you like
presets:
  - name: DIY_MATERIAL
    material: [ 0 ]
    minimum: [ [ 0.35, 0.35, 0.35 ] ]
    size: [ [ 0.25, 0.25, 0.25 ] ]

  - name: DIY_MATERIAL and SOLID_CUBE
    material: [ 1, 0 ]
    minimum: [ [ 0.30, 0.6, 0.30 ], [ 0.40, 0.25, 0.40 ] ]
    size: [ [ 0.25, 0.25, 0.25 ], [ 0.25, 0.25, 0.25 ] ]
)";

/// The original with `from` replaced by `to`.
std::string with(const std::string& from, const std::string& to) {
  std::string text(original);
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refused(const std::string& from, const std::string& to) {
  return dreampm::test::refusal([&] { parse_report_config(with(from, to), "c.yaml"); });
}

TEST(ReportConfig, TheOriginalIsReadAndIsWhatIsBuiltIn) {
  EXPECT_EQ(parse_report_config(original, "config.yaml"), report_config());
  const auto file = std::filesystem::temp_directory_path() / "dreampm_report_config.yaml";
  replace_file_text(file, original);
  EXPECT_EQ(load_report_config(file), report_config());
  std::filesystem::remove(file);
  EXPECT_THAT(dreampm::test::refusal([&] { load_report_config(file); }), HasSubstr(file.string()));
}

TEST(ReportConfig, KeysWithBlanksAreRead) {
  std::string text = with("grid number: 32", "grid number: 64");
  text.replace(text.find("max timestep: 4"), 15, "max timestep: 2");
  text.replace(text.find("max hard: 4"), 11, "max hard: 2.5");
  const ReportConfig c = parse_report_config(text, "config.yaml");
  EXPECT_EQ(c.grid, 64);
  EXPECT_EQ(c.max_time_step, 2);
  EXPECT_EQ(c.max_hard, 2.5);
}

TEST(ReportConfig, RefusesWhatIsWrongWithItsPlace) {
  EXPECT_THAT(refused("grid number", "grid numbr"),
              HasSubstr("c.yaml:6:1: error: unknown key 'grid numbr'; did you mean 'grid number'?"));
  EXPECT_THAT(refused("grid number: 32", ""), HasSubstr("missing key 'grid number'"));
  EXPECT_THAT(refused("grid number: 32", "grid number: 7"),
              StartsWith("c.yaml:6:14: error: grid number is 7: must be a whole number between 8 and 256"));
  EXPECT_THAT(refused("grid number: 32", "grid number: 257"), HasSubstr("between 8 and 256"));
  EXPECT_THAT(refused("grid number: 32", "grid number: 32.5"), HasSubstr("must be a whole number"));
  EXPECT_THAT(refused("width: 1920", "width: 0"), StartsWith("c.yaml:2:8: error: width is 0"));
  EXPECT_THAT(refused("height: 1080", "height: -1"), StartsWith("c.yaml:3:9: error: height is -1"));
  EXPECT_THAT(refused("max timestep: 4", "max timestep: 0"), HasSubstr("max timestep is 0: must be above 0"));
  EXPECT_THAT(refused("max hard: 4", "max hard: nan"), HasSubstr("must be a finite number"));
  EXPECT_THAT(refused("max hard: 4", "max hard: 4\nmax hard: 5"),
              StartsWith("c.yaml:9:1: error: duplicate key 'max hard' (first in line 8)"));
  EXPECT_THAT(refused("id: 1", "id: 2"), HasSubstr("must be 0 (the DIY material) or 1 (the solid cube)"));
  EXPECT_THAT(refused("id: 1", "id: 0"), HasSubstr("materials[1].id is 0, as that of DIY_MATERIAL"));
  EXPECT_THAT(refused("[ 0.93, 0.33, 0.23, 1.0 ]", "[ 0.93, 0.33, 0.23 ]"),
              HasSubstr("materials[1].default color is a list of 3: must be a list of 4 numbers"));
  EXPECT_THAT(refused("0.93", "93"), HasSubstr("materials[1].default color[0] is 93: must be between 0 and 1"));
}

TEST(ReportConfig, RefusesPresetsThatDoNotFitTogether) {
  EXPECT_THAT(refused("[ 1, 0 ]", "[ 3, 0 ]"),
              StartsWith("c.yaml:33:17: error: presets[1].material[0] is 3: there is no material of that id; known: 0 "
                         "(DIY_MATERIAL), 1 (SOLID_CUBE)"));
  EXPECT_THAT(refused("[ 1, 0 ]", "[ 1 ]"),
              StartsWith("c.yaml:34:14: error: presets[1].minimum has 2 entries and presets[1].material 1"));
  EXPECT_THAT(refused("[ 1, 0 ]", "[]"), HasSubstr("presets[1].material is empty"));
  EXPECT_THAT(
      refused("0.30, 0.6, 0.30", "0.30, 0.8, 0.30"),
      AllOf(StartsWith("c.yaml:35:21: error: presets[1].size[0][1] is 0.25"), HasSubstr("must be at most 0.2")));
  EXPECT_THAT(refused("0.30, 0.6, 0.30", "0.30, -0.1, 0.30"), HasSubstr("minimum[0][1] is -0.1"));
  EXPECT_THAT(refused("[ [ 0.25, 0.25, 0.25 ] ]", "[ [ 0.25, 0, 0.25 ] ]"),
              HasSubstr("size[0][1] is 0: must be above 0"));
  EXPECT_THAT(refused("[ [ 0.25, 0.25, 0.25 ] ]", "[ 0.25, 0.25, 0.25 ]"), HasSubstr("must be a list of 3 numbers"));
  // Ends on the wall up to rounding.
  EXPECT_NO_THROW(
      parse_report_config(with("minimum: [ [ 0.35, 0.35, 0.35 ] ]\n    size: [ [ 0.25, 0.25, 0.25 ] ]",
                               "minimum: [ [ 0.7, 0.35, 0.35 ] ]\n    size: [ [ 0.30000000000000004, 0.25, 0.25 ] ]"),
                          "c.yaml"));
}

TEST(ReportConfig, RefusesWhatIsNoConfig) {
  for (const char* text : {"", "# nothing\n\n  # here"})
    EXPECT_THAT(dreampm::test::refusal([&] { parse_report_config(text, "c.yaml"); }),
                HasSubstr("a config has width, height"));
  EXPECT_THAT(dreampm::test::refusal([] { parse_report_config("[1, 2]", "c.yaml"); }),
              HasSubstr("the config is a list"));
  EXPECT_THAT(dreampm::test::refusal([] { parse_report_config("width: [", "c.yaml"); }), HasSubstr("not valid YAML"));
}

TEST(ReportScene, HoldsTheReportsParticlesAtTheReportsSettings) {
  for (const int grid : {32, 64})
    for (std::size_t preset : {0u, 1u}) {
      ReportConfig config = report_config();
      config.grid = grid;
      std::vector<std::string> warnings;
      const Scene scene = parse_scene(report_scene(config, preset), "report", {}, &warnings);
      EXPECT_THAT(warnings, testing::IsEmpty());
      const Simulation simulation(scene);
      const double wanted = std::pow(grid, 3) / 4;
      EXPECT_NEAR(double(simulation.particle_count()), wanted, 0.02 * wanted);
      if (preset == 1) {
        EXPECT_NEAR(double(simulation.particles("diy").size()), wanted / 2, 0.02 * wanted / 2);
        EXPECT_NEAR(double(simulation.particles("cube").size()), wanted / 2, 0.02 * wanted / 2);
      }
      const auto& space = scene.model().space;
      EXPECT_NEAR(space.spacing * std::cbrt(space.particles_per_cell), 1.0 / grid, 1e-9) << "the report's cells";
      EXPECT_EQ(scene.model().gravity.y, -9.8);
    }
}

TEST(ReportScene, HasTheReportsMaterials) {
  const Scene scene = parse_scene(report_scene(report_config(), 1), "report");
  const auto& materials = scene.model().materials;
  ASSERT_EQ(scene.materials(), (std::vector<std::string>{"cube", "diy"}));
  EXPECT_EQ(materials[1].type, "seed");
  EXPECT_EQ(materials[1].values["v"], 0.5);
  EXPECT_EQ(materials[1].values["lower"], -250);
  EXPECT_EQ(materials[1].values["upper"], 45);
  // mu and lambda again, at max hard 4.
  const double e = materials[0].values["youngs_modulus"], nu = materials[0].values["poissons_ratio"];
  EXPECT_NEAR(e / (2 * (1 + nu)), 4 * 416.6, 1e-6);
  EXPECT_NEAR(e * nu / ((1 + nu) * (1 - 2 * nu)), 4 * 277.7, 1e-6);
  EXPECT_EQ(scene.model().render.looks.at("cube").color, (Vec3d{0.93, 0.33, 0.23}));
}

TEST(ReportScene, RunsAndFalls) {
  Simulation simulation(parse_scene(report_scene(report_config(), 0), "report"));
  simulation.advance_to(0.05);
  const Totals t = simulation.totals();
  EXPECT_NEAR(t.momentum.y / t.mass, -9.8 * simulation.time(), 1e-3);
}

TEST(ReportScene, RefusesAPresetThatIsNotThere) {
  EXPECT_THAT(dreampm::test::refusal([] { report_scene(report_config(), 2); }), HasSubstr("the config has 2"));
}

TEST(ReportScene, TakesWhateverTheConfigTakes) {
  ReportConfig config = report_config();
  config.width = 641, config.height = 359;
  config.presets = {{"say \"it\": #1", {0, 0}, {{0, 0, 0}, {0.5, 0.5, 0.5}}, {{0.05, 0.05, 0.05}, {0.5, 0.5, 0.5}}}};
  const Scene scene = parse_scene(report_scene(config, 0), "report");
  EXPECT_EQ(scene.model().render.width, 640);
  EXPECT_NEAR(double(Simulation(scene).particle_count()), 8192, 0.02 * 8192);
}

}  // namespace
}  // namespace dreampm::play::report_config_test
