// Wrong command lines, and those typed to learn.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "dreampm/io/ledger.h"
#include "dreampm/io/ply.h"
#include "dreampm/physics/dt.h"
#include "typed.h"

namespace dreampm::test {
namespace {
using nlohmann::json;
using testing::HasSubstr;

class Usage : public Typing {};

/// The verbs that a help page names.
std::vector<std::string> verbs_in(const std::string& help) {
  std::vector<std::string> verbs;
  const std::size_t head = help.find("\nSubcommands:\n");
  if (head == std::string::npos) return verbs;
  std::istringstream lines(help.substr(help.find('\n', head + 1) + 1));
  // Two blanks and the verb; what is deeper goes on with the text above.
  for (std::string line; std::getline(lines, line) && line.starts_with("  ");)
    if (line[2] != ' ') verbs.push_back(line.substr(2, line.find(' ', 2) - 2));
  return verbs;
}

TEST_F(Usage, EveryVerbsHelpShowsAnExample) {
  std::vector<std::string> verbs = verbs_in(type("--help").out);
  EXPECT_GE(verbs.size(), 11u);
  EXPECT_THAT(verbs, testing::IsSupersetOf({"make", "validate", "bench"}));
  for (std::size_t i = 0; i < verbs.size(); ++i) {  // it grows by verbs of verbs
    const std::string verb = verbs[i];
    const Typed t = type(verb + " --help");
    EXPECT_EQ(t.code, 0) << verb;
    EXPECT_THAT(t.out, HasSubstr("Example:\n  dreampm " + verb)) << verb;
    for (const std::string& own : verbs_in(t.out)) verbs.push_back(verb + " " + own);
  }
  EXPECT_THAT(verbs, testing::Contains("bench step"));
  EXPECT_THAT(type("--help").out, HasSubstr("Example:\n  dreampm make"));
  // Each line of an example that has several begins alike.
  EXPECT_THAT(type("surface --help").out, testing::ContainsRegex("Example:\n  dreampm .*\n  dreampm "));
  EXPECT_THAT(type("help --markdown").out,
              testing::ContainsRegex("```sh\ndreampm surface .*\ndreampm surface .*\n```"));
  EXPECT_THAT(type("--version").out, testing::MatchesRegex("dreampm [0-9]+\\.[0-9]+\\.[0-9]+ .*\n"));
}

TEST_F(Usage, BenchTellsWhatWasMeasuredAndWhatTheMachineCould) {
  const Typed t = type("bench step --material elastic --particles 8000 --isa sse4 --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json all = json::parse(t.out), &r = all.at("results").at(0);
  for (const char* key : {"machine", "compiler", "commit"}) EXPECT_FALSE(all.at(key).get<std::string>().empty());
  for (const char* key : {"fma_gflops", "triad_gb_s"}) EXPECT_GT(all.at("ceilings").at(key).get<double>(), 0.1) << key;
  EXPECT_EQ(r.at("material"), "elastic");
  EXPECT_EQ(r.at("isa"), "sse4");
  EXPECT_NEAR(r.at("particles").get<double>(), 8000, 400);
  const double ns = r.at("ns_per_particle_step");
  EXPECT_NEAR(r.at("mps").get<double>(), 1e3 / ns, 1e-6);
  EXPECT_EQ(r.at("windows").size(), 5u);
  double shares = 0;
  for (const auto& [stage, share] : r.at("stages").items()) shares += share.get<double>();
  EXPECT_GT(shares, 0.5);
  EXPECT_LE(shares, 1);
  // No step does fewer operations than this; a multiply-add ceiling below it is wrong.
  EXPECT_LT(100 / ns, all.at("ceilings").at("fma_gflops").get<double>());
  // A floor that a step comes below is none. Memory's may be, in caches.
  EXPECT_LT(r.at("floors").at("fma_ns").get<double>(), ns);
  EXPECT_GT(r.at("floors").at("bandwidth_ns").get<double>(), 0);
  EXPECT_GE(r.at("memory_per_particle").get<double>(), 0);  // 0: too little to measure
}

TEST_F(Usage, BenchAllIsATableOfEveryCase) {
  const std::string small = "bench all --isa sse4 --shrink 16 --windows 1 --seconds 0.001";
  Typed t = type(small + " --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json all = json::parse(t.out);
  EXPECT_FALSE(all.at("machine").get<std::string>().empty());
  EXPECT_EQ(all.at("shrink"), 16);
  const json& rows = all.at("results");
  EXPECT_EQ(rows[0].at("case"), "ceiling: multiply-adds");
  std::set<std::string> units, cases;
  for (const json& r : rows) {
    // So little memory cannot be measured.
    if (r.at("unit") != "B") {
      EXPECT_GT(r.at("value").get<double>(), 0) << r;
    }
    EXPECT_EQ(r.at("isa"), "sse4");
    units.insert(r.at("unit")), cases.insert(r.at("case"));
  }
  EXPECT_EQ(units, (std::set<std::string>{"Gflop/s", "GB/s", "M/s", "x", "B", "%"}));
  for (const char* material : {"newtonian", "snow", "elastic", "sand", "seed"}) EXPECT_TRUE(cases.count(material));
  t = type("bench all --isa sse5");
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.out, "") << "a table that has no rows";
  EXPECT_EQ(type("bench step --cells 4 4").code, 2);
  t = type("bench step --cells 8 4 4 --windows 2 --seconds 0.001 --each");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, testing::MatchesRegex("window [0-9.]+ [0-9.]+\nwindow [0-9.]+ [0-9.]+\nstep, newtonian, 1,024 "
                                           "particles(.|\n)*"));
  t = type("bench step --droplets --particles 100 --windows 1 --seconds 0.001");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, testing::StartsWith("step, newtonian, 96 particles in droplets, 1 thread, "));
  EXPECT_EQ(type("bench step --droplets --cells 4 4 4").code, 2);
}

TEST_F(Usage, BenchMeasuresWhatTapsCostBesideTheStep) {
  const std::string small = "bench step --cells 12 8 12 --threads 2 --windows 1 --seconds 0.001";
  for (const char* solver : {"", " --solver projection"}) {
    Typed t = type(small + solver + " --emitter --sink --moving --edit --json");
    ASSERT_EQ(t.code, 0) << t.err;
    const json rows = json::parse(t.out).at("results");
    ASSERT_EQ(rows.size(), 12u);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const std::string name = rows[r].at("case");
      EXPECT_THAT(name, testing::StartsWith(*solver ? "projection" : "steps"));
      EXPECT_EQ(rows[r].at("threads"), 2);
      EXPECT_EQ(rows[r].at("unit"), r % 3 < 2 ? "M/s" : "%") << name;
      if (r % 3 < 2) {
        EXPECT_GT(rows[r].at("value").get<double>(), 0) << name;
      }
      EXPECT_EQ(name.find("cost of") != std::string::npos, r % 3 == 2) << name;
    }
    // Both start from the same matter; what taps do to it is seen there.
    const auto particles = [&](std::size_t row) { return rows[row].at("particles").get<int>(); };
    for (const std::size_t tap : {0, 3, 6, 9}) EXPECT_EQ(particles(tap), particles(tap + 1));
    EXPECT_GT(particles(0), particles(9)) << "an emitter";
    EXPECT_LT(particles(3), particles(9)) << "a sink";
    EXPECT_LT(particles(6), particles(9)) << "a mesh takes room";
  }
  const Typed t = type(small + " --material snow --sink");
  EXPECT_THAT(t.out, testing::HasSubstr("| steps: cost of a sink | "));
  EXPECT_EQ(type("bench step --sink --droplets").code, 2);
  EXPECT_EQ(type("bench step --sink --solver projection --material snow").code, 2);
}

TEST_F(Usage, BenchMeasuresTheProjectionInCalmWaterAndInASplash) {
  const std::string small = "bench step --solver projection --cells 8 8 4 --windows 1 --seconds 0.001";
  Typed t = type(small + " --threads 2 --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json rows = json::parse(t.out).at("results");
  ASSERT_EQ(rows.size(), 4u);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_EQ(rows[r].at("case"), r < 2 ? "projection, calm water" : "projection, a splash");
    EXPECT_EQ(rows[r].at("threads"), 1 + r % 2);
    EXPECT_EQ(rows[r].at("particles"), 8 * 8 * 8 * 4);
    EXPECT_GT(rows[r].at("value").get<double>(), 0);
  }
  t = type(small);
  EXPECT_THAT(t.out, testing::HasSubstr("| projection, a splash | 2,048 | "));
  t = type(small + " --material snow");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, testing::HasSubstr("--material"));
}

TEST_F(Usage, BenchFramesIsTheCostBesideExplicitSteps) {
  const std::string dam =
      "bench frames " DM_SOURCE_DIR "/scenes/dam-break.yaml --set space.spacing=0.033333 --frames 3";
  const Typed t = type(dam + " --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json all = json::parse(t.out);
  EXPECT_GT(all.at("explicit").at("steps").get<int>(), 10 * all.at("projection").at("steps").get<int>());
  EXPECT_GT(all.at("ratio").get<double>(), 0);
  EXPECT_EQ(type(dam + " --set materials.water.type=snow").code, 2);
}

TEST_F(Usage, WrongLinesExitWithTwo) {
  Typed t = type("mkae dam.yaml");
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.err, "error: no verb 'mkae'; did you mean 'make'?\n");
  EXPECT_EQ(type("").code, 2);
  EXPECT_EQ(type("make").code, 2);
  t = type("materials --jsn");
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.err, "error: materials has no option '--jsn'; did you mean '--json'?\n");
  EXPECT_THAT(type("bench step --particels=64").err, HasSubstr("step has no option '--particels'; did you mean"));
  t = type("bench stpe");
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.err, "error: no verb 'stpe'; did you mean 'step'?\n");
  EXPECT_THAT(type("materials more").err, HasSubstr("more"));
  t = type("make nowhere.yaml");
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.err, "error: nowhere.yaml: no such scene file\n");
  EXPECT_EQ(type("run nowhere.yaml --backend gpu").code, 2);
  EXPECT_EQ(type("surface nowhere").code, 2);
  EXPECT_EQ(type("info nowhere.ply").code, 2);
  EXPECT_EQ(type("points asset:knot --spacing 0").code, 2);
  EXPECT_EQ(type("points asset:knot --spacing 0.1 --fit 1 --scale 2").code, 2);
}

TEST_F(Usage, NumbersOfThingsAreWholeAndNotWrapped) {
  // 2^64 + 64 is 64 where it wraps.
  for (const char* line :
       {"bench step --particles -64", "bench step --particles 18446744073709551680", "bench step --cells 4 4 -4",
        "bench all --shrink 0", "run dam.yaml --frames -1", "make dam.yaml --threads 4294967297",
        "render out --frame -1", "render out --samples -1", "render out --samples 18446744073709551680"}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line;
    EXPECT_THAT(t.err, HasSubstr(" is no whole number from ")) << line;
  }
  for (const char* line : {"bench step --seconds nan", "validate stability --cfl nan", "validate stability --cfl 11"}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << line;
    EXPECT_THAT(t.err, HasSubstr(" is no number from ")) << line;
  }
  write("dam.yaml", tiny_dam);
  ASSERT_EQ(type("run dam.yaml --frames 02").code, 0);
  EXPECT_EQ(json::parse(type("info out/dam --json").out).at("simulate_frames"), 2);
}

TEST_F(Usage, SceneErrorsNameTheirPlace) {
  std::string scene = tiny_dam;
  scene.replace(scene.find("cfl"), 3, "clf");
  scene.replace(scene.find("samples: 4"), 10, "samples: 1");
  write("dam.yaml", scene);
  for (const std::string verb : {"make", "run", "check"}) {
    const Typed t = type(verb + " dam.yaml");
    EXPECT_EQ(t.code, 2) << verb;
    EXPECT_THAT(t.err, HasSubstr("dam.yaml:4:28: error: ")) << verb;
    EXPECT_THAT(t.err, HasSubstr("did you mean 'cfl'?")) << verb;
    EXPECT_THAT(t.err, HasSubstr("\ndam.yaml:10:35: error: ")) << verb;
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << verb;
  }
  const Typed t = type("check dam.yaml --json");
  EXPECT_EQ(t.code, 2);
  const json errors = json::parse(t.out).at("errors");
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].at("line"), 4);
  EXPECT_EQ(errors[0].at("column"), 28);
}

TEST_F(Usage, CheckCountsWhatARunNeeds) {
  write("dam.yaml", tiny_dam);
  const Typed t = type("check dam.yaml --json");
  ASSERT_EQ(t.code, 0) << t.err;
  const json j = json::parse(t.out);
  EXPECT_EQ(j.at("particles"), 8 * 10 * 10);
  EXPECT_NEAR(j.at("dx").get<double>(), 0.06, 1e-12);
  EXPECT_GT(j.at("dt").get<double>(), 0);
  EXPECT_GT(j.at("memory_bytes").get<double>(), 0);
  for (const char* stage : {"simulate", "surface", "render", "video"})
    EXPECT_GT(j.at("seconds").at(stage).get<double>(), 0) << stage;
  EXPECT_THAT(type("check dam.yaml").out, HasSubstr("800 particles"));
}

TEST_F(Usage, CheckCountsTheShortStepsOfWhatLiesInLargeOnes) {
  std::string scene = tiny_dam;
  scene.insert(scene.find("output:"),
               "  heap: {material: sand, shape: {box: {min: [0.3, 0.1, 0.1], max: [0.5, 0.3, 0.3]}}}\n");
  scene.insert(scene.find("bodies:"), "  sand: {type: sand}\n");
  write("heap.yaml", scene), write("dam.yaml", tiny_dam);
  const std::string large = " --set time.solver=projection";
  EXPECT_THAT(type("check dam.yaml" + large).out, testing::Not(HasSubstr("short ones")));
  EXPECT_THAT(type("check heap.yaml" + large).out,
              testing::ContainsRegex("and [0-9]+ short ones in each of what lies in the liquid"));
}

TEST_F(Usage, CheckAndTheLedgerTellOfStagesOfViscosity) {
  write("dam.yaml", tiny_dam);
  const std::string thick = " dam.yaml --set materials.water.viscosity=1000 --set materials.water.max_compression=0.2";
  const Typed t = type("check" + thick);
  EXPECT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, testing::ContainsRegex("substeps a frame, each in [0-9]+ stages of viscosity"));
  const int stages = json::parse(type("check --json" + thick).out).at("stages");
  EXPECT_GE(stages, 2);
  EXPECT_THAT(type("check dam.yaml").out, testing::Not(HasSubstr("stages")));
  EXPECT_EQ(json::parse(type("check dam.yaml --json").out).at("stages"), 0);

  ASSERT_EQ(type("run --frames 2" + thick).code, 0);
  const Ledger ledger = read_ledger(folder / "out/dam/ledger.csv");
  EXPECT_EQ(ledger.rows.at(0).stages, 0) << "nothing has happened yet";
  EXPECT_EQ(ledger.rows.at(1).stages, stages);

  const Typed far = type(
      "run --overwrite --frames 1 --set time.dt=1.7e-3 --set space.spacing=0.01 --set materials.water.density=100" +
      thick);
  EXPECT_THAT(far.err, testing::ContainsRegex("every step takes [0-9]+ stages .* save nothing beyond .* 20 stages"));
}

TEST_F(Usage, CheckTellsOfEveryBodyThatCannotStart) {
  std::string scene = tiny_dam;
  const std::string bodies = "bodies:\n";
  scene.insert(scene.find(bodies) + bodies.size(),
               "  high: {material: water, shape: {sphere: {radius: 0.1}, center: [0.3, 0.3, 0.28]}}\n"
               "  tiny: {material: water, shape: {sphere: {radius: 0.001}, center: [0.301, 0.2, 0.1]}}\n");
  write("dam.yaml", scene);
  const Typed t = type("check dam.yaml --json");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("dam.yaml:8:3: error: body high reaches "));
  EXPECT_THAT(t.err, HasSubstr("outside the wall z_max"));
  const json errors = json::parse(t.out).at("errors");
  ASSERT_EQ(errors.size(), 2u) << t.out;
  EXPECT_EQ(errors[0].at("file"), "dam.yaml");
  EXPECT_EQ(errors[0].at("line"), 8);
  EXPECT_EQ(errors[0].at("column"), 3);
  EXPECT_EQ(errors[1].at("line"), 9);
  EXPECT_THAT(errors[1].at("message").get<std::string>(), HasSubstr("tiny holds no particle"));
}

/// `check` finds what `run` would refuse, in the same words, and `run` does so before it touches an
/// earlier run.
TEST_F(Usage, AProbeWithoutMatterIsRefusedWhereItIsNamed) {
  write("dam.yaml", tiny_dam);
  ASSERT_EQ(type("run dam.yaml --frames 1").code, 0);
  write("dam.yaml", tiny_dam + "probes:\n  p: {type: point, body: column, at: [0.59, 0.39, 0.19]}\n");
  const Typed checked = type("check dam.yaml"), ran = type("run dam.yaml --overwrite");
  EXPECT_EQ(checked.code, 2);
  EXPECT_EQ(ran.code, 2);
  const auto error = testing::ContainsRegex("dam.yaml:[0-9]+:3: error: probe p: at .* the body column has no matter");
  EXPECT_THAT(checked.err, error);
  EXPECT_THAT(ran.err, error);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/dam/particles/particles_000001.ply"));
}

/// Like a time.cfl beyond its range; what is offered instead is taken.
TEST_F(Usage, AFixedStepThatSoundOutrunsIsRefusedWhereItStands) {
  write("dam.yaml", tiny_dam);
  ASSERT_EQ(type("run dam.yaml --frames 1").code, 0);
  std::string scene = tiny_dam;
  scene.replace(scene.find("cfl: 0.5"), 8, "dt: 1.0e-2");
  write("dam.yaml", scene);
  const Typed checked = type("check dam.yaml --json"), ran = type("run dam.yaml --overwrite");
  EXPECT_EQ(checked.code, 2);
  EXPECT_EQ(ran.code, 2);
  const std::string error = "dam.yaml:4:32: error: time.dt is 0.01: must be at most ";
  EXPECT_THAT(ran.err, HasSubstr(error));
  EXPECT_TRUE(std::filesystem::exists(folder / "out/dam/particles/particles_000001.ply"));
  const json errors = json::parse(checked.out).at("errors");
  ASSERT_EQ(errors.size(), 1u) << checked.out;
  EXPECT_EQ(errors[0].at("line"), 4);
  EXPECT_EQ(errors[0].at("column"), 32);
  ASSERT_THAT(checked.err, HasSubstr(error));
  const double offered = std::stod(checked.err.substr(checked.err.find(error) + error.size()));
  // Sound at 10.7 m/s takes half a cell of 6 cm.
  EXPECT_NEAR(offered, 0.5 * 0.06 / (wave_margin * 10.7), 0.01 * offered);
  EXPECT_EQ(type(fmt::format("check dam.yaml --set time.dt={}", offered)).code, 0);
  EXPECT_THAT(type(fmt::format("check dam.yaml --set time.dt={}", 1.1 * offered)).err,
              HasSubstr("dam.yaml: error: time.dt is "));
}

TEST_F(Usage, CheckTellsOfEveryFileThatCannotBeReadAtThePlaceThatNamesIt) {
  write("broken.ply", "hello");
  write("empty.ply", "");
  write("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  std::string scene = tiny_dam;
  const std::string bodies = "bodies:\n";
  scene.insert(scene.find(bodies) + bodies.size(),
               "  cloud: {material: water, shape: {points: empty.ply}}\n"
               "  sheet: {material: water, shape: {mesh: flat.off}}\n");
  write("dam.yaml", scene + "colliders: {rock: {shape: {mesh: broken.ply}}}\n");
  const Typed t = type("check dam.yaml --set output.folder=dam.yaml/here --json");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("dam.yaml:8:3: error: body cloud: empty.ply: "));
  EXPECT_THAT(t.err, HasSubstr("dam.yaml:9:3: error: body sheet: flat.off: encloses nothing"));
  EXPECT_THAT(t.err, HasSubstr("dam.yaml:13:13: error: collider rock: broken.ply: "));
  EXPECT_EQ(json::parse(t.out).at("errors").size(), 4u) << t.out;  // and the folder
}

TEST_F(Usage, CheckLooksWhereTheRunWouldGo) {
  write("dam.yaml", tiny_dam);
  write("notes", "a file");
  const Typed t = type("check dam.yaml --set output.folder=notes/here");
  EXPECT_EQ(t.code, 2);
  EXPECT_THAT(t.err, HasSubstr("notes is a file; name another folder"));
  const json some = json::parse(type("check dam.yaml --json").out),
             larger = json::parse(type("check dam.yaml --json --set render.size=[640,360]").out);
  // Pictures count: PNGs of these take 1 to 2 bytes a pixel.
  EXPECT_GT(larger.at("disk_bytes").get<double>(), some.at("disk_bytes").get<double>() + 3 * 640 * 350);
}

TEST_F(Usage, InfoGivesNumbersAndAScenesMass) {
  write("dam.yaml", tiny_dam);
  const json scene = json::parse(type("info dam.yaml --json").out);
  EXPECT_EQ(scene.at("particles"), 800);
  EXPECT_NEAR(scene.at("mass").get<double>(), 1000 * 0.24 * 0.3 * 0.3, 1e-6);
  EXPECT_EQ(scene.at("frames"), 3);
  ASSERT_EQ(type("run dam.yaml --frames 2").code, 0);
  const json run = json::parse(type("info out/dam --json").out);
  EXPECT_NEAR(run.at("mass").get<double>(), 1000 * 0.24 * 0.3 * 0.3, 1e-6);
  EXPECT_LT(run.at("momentum")[1].get<double>(), 0);
  EXPECT_EQ(run.at("simulate_frames"), 2);
  const json state = json::parse(type("info out/dam/checkpoint/checkpoint_000002.h5 --json").out);
  EXPECT_EQ(state.at("count"), 800);
  EXPECT_EQ(state.at("frame"), 2);
  EXPECT_NEAR(state.at("time").get<double>(), 1.0 / 24, 1e-12);
}

TEST_F(Usage, PointsTakeOverACloud) {
  write("cloud.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n0 0 0\n1 0 0\n1 2 0\n");
  const Typed t = type("points cloud.ply --spacing 0.5 --fit 0.4 --out c.ply");
  ASSERT_EQ(t.code, 0) << t.err;
  EXPECT_THAT(t.out, HasSubstr("c.ply: 3 points"));
  EXPECT_THAT(t.out, HasSubstr("the nearest two are 0.400 spacings apart"));
  const ParticleFrame frame = read_particles(folder / "c.ply");
  ASSERT_EQ(frame.size(), 3u);
  EXPECT_FLOAT_EQ(frame.position[2].y, 0.4f);
  EXPECT_EQ(json::parse(type("info cloud.ply --json").out).at("count"), 3);
}

TEST_F(Usage, PointsOfWhatIsThinnerThanTheSpacing) {
  std::string slab;
  for (const char* z : {"0", "0.009"})
    for (const char* y : {"0", "0.1"})
      for (const char* x : {"0", "0.1"}) slab += fmt::format("v {} {} {}\n", x, y, z);
  write("slab.obj", slab + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  Typed t = type("points slab.obj --spacing 0.05");
  EXPECT_EQ(t.code, 2);
  const std::string thin =
      "slab.obj: encloses nothing at a voxel of 0.05 m (it is 0.1 x 0.1 x 0.009 m); it is thinner than a voxel; it is "
      "about 0.0076 m thick: a spacing of ";
  EXPECT_THAT(t.err, HasSubstr(thin));
  EXPECT_FALSE(std::filesystem::exists(folder / "slab-points.ply"));
  const double fine = std::stod(t.err.substr(t.err.find(thin) + thin.size()));
  EXPECT_LT(fine, 0.0045);
  t = type("points slab.obj --spacing 0.007");
  EXPECT_EQ(t.code, 0);
  EXPECT_THAT(t.err, HasSubstr("warning: the particles of slab.obj hold "));
  EXPECT_THAT(t.err, HasSubstr(fmt::format("it is about 0.0076 m thick: a spacing of {} m would do", fine)));
  t = type(fmt::format("points slab.obj --spacing {}", fine));
  EXPECT_EQ(t.code, 0);
  EXPECT_EQ(t.err, "");
}

TEST_F(Usage, MaterialsTellTheirTables) {
  const Typed t = type("materials --json");
  ASSERT_EQ(t.code, 0);
  bool water = false;
  for (const json& m : json::parse(t.out)) {
    ASSERT_FALSE(m.at("parameters").empty());
    for (const json& p : m.at("parameters"))
      for (const char* key : {"key", "unit", "default", "min", "max", "help"}) EXPECT_TRUE(p.contains(key)) << key;
    if (m.at("name") != "newtonian") continue;
    water = m.at("presets").at(0).at("name") == "water" && m.at("presets").at(0).at("values").at("density") == 998.2;
  }
  EXPECT_TRUE(water);
  EXPECT_THAT(type("materials").out, HasSubstr("youngs_modulus"));
}

TEST_F(Usage, PointsFillTheKnot) {
  const double spacing = 0.015;
  const Typed t = type("points asset:knot --spacing 0.015 --fit 0.6 --out made/knot.ply");
  ASSERT_EQ(t.code, 0) << t.err;
  const ParticleFrame frame = read_particles(folder / "made" / "knot.ply");
  Box3d bounds;
  for (const Vec3f& p : frame.position) bounds.add(static_cast<Vec3d>(p));
  const Vec3d size = bounds.size();
  EXPECT_NEAR(std::max({size.x, size.y, size.z}), 0.6, 3 * spacing);
  // The volume of the closed mesh itself, by another way than the points.
  const Typed mesh = type("info asset:knot --json");
  ASSERT_EQ(mesh.code, 0) << mesh.err;
  const json knot = json::parse(mesh.out);
  double longest = 0;
  for (int a = 0; a < 3; ++a)
    longest =
        std::max(longest, knot.at("bounds").at("max")[a].get<double>() - knot.at("bounds").at("min")[a].get<double>());
  EXPECT_THAT(t.out, HasSubstr("none outside it"));
  const double volume = knot.at("volume").get<double>() * std::pow(0.6 / longest, 3);
  EXPECT_NEAR(static_cast<double>(frame.size()) * std::pow(spacing, 3) / volume, 1, 0.03);
}

}  // namespace
}  // namespace dreampm::test
