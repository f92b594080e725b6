// The list of cases, the scenes they use, and what a run of them says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "dreampm/base/file.h"
#include "validate/page.h"
#include "validate/plot.h"
#include "validate/report.h"
#include "validate/validation_run.h"

namespace dreampm::validate {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

fs::path folder(const std::string& name) {
  const fs::path f = fs::path(testing::TempDir()) / ("dreampm_validate_" + name);
  fs::remove_all(f);
  make_folder(f);
  return f;
}

TEST(Cases, HaveNamesAndSourcesAndAreFound) {
  std::set<std::string_view> names;
  for (const Case* c : all_cases()) {
    EXPECT_TRUE(names.insert(c->name).second) << c->name;
    EXPECT_FALSE(c->about.empty() || c->source.empty()) << c->name;
    EXPECT_EQ(&find_case(std::string(c->name)), c);
  }
  EXPECT_THROW(find_case("no-such-case"), InputError);
  EXPECT_LE(cases_of(Level::quick).size(), cases_of(Level::full).size());
}

TEST(Scenes, EveryBuiltInOneAssembles) {
  EXPECT_GE(scene_names().size(), 5u);
  for (const std::string& name : scene_names()) {
    const model::Scene scene = built_in_scene(name);
    EXPECT_EQ(scene.name, name);
    EXPECT_FALSE(scene.about.empty());
    // A flow that turns on the spot draws a lattice out into lines, one along a floor keeps it in
    // step with the grid.
    const auto pattern = name == "taylor-green" ? Pattern::poisson
                         : name == "pool" || name == "channel" || name == "layers" || name == "still-shore" ||
                                 name == "splash-volume" || name == "vessels" || name == "rigid-push" ||
                                 name.starts_with("dam-break")
                             ? Pattern::jitter
                             : Pattern::lattice;
    for (const auto& body : scene.bodies) EXPECT_EQ(body.pattern, pattern) << name;
    EXPECT_GT(assemble(scene, name).particles(), 0u);
  }
  EXPECT_THROW(built_in_scene("nothing"), InputError);
  EXPECT_THROW(reference_table("nothing.csv"), InputError);
}

TEST(Metrics, NanPassesNoGateAndAControlIsJudgedByItsMetric) {
  Trial t(Options{});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(t.at_most("a", nan, 1).pass());
  EXPECT_FALSE(t.at_least("b", nan, 1).pass());
  EXPECT_TRUE(t.at_most("c", 1, 1).pass());
  t.control("worse", "c", 2);
  t.control("not worse", "c", 0.5);
  EXPECT_TRUE(t.controls[0].fails);
  EXPECT_FALSE(t.controls[1].fails);
  t.report("d", 3);
  EXPECT_THROW(t.control("of no gate", "d", 1), std::logic_error);
}

TEST(Metrics, AControlMayHaveToGoBeyondItsGate) {
  Trial t(Options{});
  t.at_most("most", 1, 2);
  t.at_least("least", 5, 4);
  t.control("far", "most", 9, 8);
  t.control("not far enough", "most", 3, 8);
  t.control("far", "least", 1, 2);
  t.control("not far enough", "least", 3, 2);
  t.control("nothing", "most", std::numeric_limits<double>::quiet_NaN(), 8);
  const bool fails[] = {true, false, true, false, false};
  for (std::size_t i = 0; i < std::size(fails); ++i) EXPECT_EQ(t.controls[i].fails, fails[i]) << i;
  EXPECT_THROW(t.control("a bound that passes", "most", 9, 1.5), std::logic_error);
}

const Case misses{
    "misses", "a gate that is missed", "nowhere", true, [](Trial& t) {
      t.at_most("too much", 2, 1, "m").known("it is meant to", 1.5);
      t.control("wrong", "too much", 3);
      t.note_choice("What was chosen, and why.");
      t.set_up("scene", "of water");
      t.set_up("scene", "of honey, for a control");
      t.plot({"misses", "A <plot>", "x", "y", {{"ours", {0, 1, 2}, {0, 1, NAN}}, {"them", {0}, {5}, true}}});
      t.cost(7);
    }};
const Case misses_more{"misses-more", "a gate that is missed by more than is known", "nowhere", true, [](Trial& t) {
                         t.at_most("too much", 2, 1, "m").known("it is meant to", 1.5);
                         t.control("wrong", "too much", 3);
                       }};
const Case misses_as_known{"misses-as-known", "a gate that is missed as it is known to be", "nowhere", true,
                           [](Trial& t) {
                             t.at_most("too much", 2, 1).known("it is meant to", 2.5);
                             t.at_least("too little", 1, 2).known("it is meant to", 0.5);
                             t.control("wrong", "too much", 3);
                             t.control("wrong", "too little", 0);
                           }};
const Case halfway{"halfway", "a control that is not wrong enough", "nowhere", true, [](Trial& t) {
                     t.at_most("some", 0, 1, "%");
                     t.control("wrong", "some", 1.5, 2);
                   }};
const Case breaks{"breaks", "a run that ends early", "nowhere", true, [](Trial&) { fail_run("dt is nothing"); }};
const Case blind{"blind", "a gate that lets everything pass", "nowhere", true, [](Trial& t) {
                   t.at_most("anything", 0, 1);
                   t.control("nothing", "anything", 0.5);
                 }};

const Case trusting{"trusting", "a gate that nothing wrong was compared with", "nowhere", true, [](Trial& t) {
                      t.at_most("judged", 0, 1);
                      t.control("wrong", "judged", 2);
                      t.at_most("believed", 0, 1);
                      t.report("reported", 0);
                    }};

TEST(Report, AMissABlindControlAndABrokenRunAllFail) {
  const fs::path out = folder("report");
  std::vector<Result> results;
  for (const Case* c : {&misses, &breaks, &blind}) results.push_back(run_case(*c, Options{}, out));
  for (const Result& r : results) EXPECT_FALSE(r.passed()) << r.which->name;
  EXPECT_THAT(text_of(results[0]), HasSubstr("MISS"));
  EXPECT_THAT(text_of(results[0]), HasSubstr("known, up to 1.5 m: it is meant to"));
  EXPECT_THAT(text_of(results[2]), HasSubstr("NOT CAUGHT"));
  EXPECT_THAT(summary_of(results, 1), HasSubstr("0 of 3 cases passed"));
  EXPECT_THAT(summary_of(results, 1), HasSubstr("failed: breaks: dt is nothing"));
  const auto json = nlohmann::json::parse(json_of(results));
  EXPECT_EQ(json["failed"], 3);
  const auto& first = json["cases"][0];
  EXPECT_EQ(first["metrics"][0]["value"], 2);
  EXPECT_EQ(first["metrics"][0]["gate"], 1);
  EXPECT_EQ(first["metrics"][0]["pass"], false);
  EXPECT_EQ(first["control"]["fails"], true);
  EXPECT_EQ(first["particle_steps"], 7);
  EXPECT_TRUE(fs::exists(first["plot"].get<std::string>()));
  const std::string page = page_with(results, "images");
  EXPECT_THAT(page, HasSubstr("![misses](images/misses.svg)"));
  EXPECT_THAT(page,
              HasSubstr("- What was chosen, and why.\n- [scene](../scenes/validation/scene.yaml): of water\n\n|"));
  EXPECT_THAT(page, Not(HasSubstr("honey"))) << "the first run of a scene counts";
  EXPECT_THAT(text_of(results[0]), HasSubstr("set-up: What was chosen, and why."));
  EXPECT_EQ(first["set_up"], nlohmann::json({"What was chosen, and why.", "scene: of water"}));
}

TEST(Report, AMissIsKnownOnlyAsFarAsItsDiagnosisReaches) {
  const fs::path out = folder("known");
  const Result known = run_case(misses_as_known, Options{}, out), worse = run_case(misses_more, Options{}, out);
  EXPECT_FALSE(known.passed());
  EXPECT_TRUE(known.known());
  EXPECT_FALSE(worse.known());
  EXPECT_TRUE(succeeded({known}));
  EXPECT_FALSE(succeeded({known, worse}));
  EXPECT_FALSE(run_case(blind, Options{}, out).known());
  EXPECT_FALSE(run_case(breaks, Options{}, out).known());
  const std::string summary = summary_of({known, worse}, 1);
  EXPECT_THAT(summary, HasSubstr("0 of 2 cases passed, 1 missed only gates that they are known to miss, 1 failed"));
  EXPECT_THAT(summary, HasSubstr("missed, known: misses-as-known: too much"));
  EXPECT_THAT(summary, HasSubstr("missed: misses-more: too much"));
}

TEST(Report, TellsHowWrongAControlHasToBe) {
  const Result r = run_case(halfway, Options{}, folder("halfway"));
  EXPECT_FALSE(r.passed());
  EXPECT_THAT(text_of(r), HasSubstr("> 200 %"));
  EXPECT_THAT(page_with({r}, "images"), HasSubstr("| control: wrong (some) | 150 % | > 200 % | NOT CAUGHT |"));
  EXPECT_THAT(summary_of({r}, 1), HasSubstr("not caught: halfway: some: wrong"));
  EXPECT_EQ(nlohmann::json::parse(json_of({r}))["cases"][0]["control"]["beyond"], 2);
}

TEST(Report, AGateWithoutAControlFailsItsCase) {
  const Result r = run_case(trusting, Options{}, folder("trusting"));
  EXPECT_FALSE(r.passed() || r.known());
  const std::string missed = summary_of({r}, 1);
  EXPECT_THAT(missed, HasSubstr("without a control: trusting: believed"));
  EXPECT_THAT(missed, Not(HasSubstr("judged")));
  EXPECT_THAT(missed, Not(HasSubstr("reported")));
  EXPECT_THAT(text_of(r), HasSubstr("ok, NO CONTROL"));
  EXPECT_THAT(page_with({r}, "images"), HasSubstr("| believed | 0 | <= 1 | ok, NO CONTROL |"));
  const auto metrics = nlohmann::json::parse(json_of({r}))["cases"][0]["metrics"];
  EXPECT_EQ(metrics[0]["controlled"], true);
  EXPECT_EQ(metrics[1]["controlled"], false);
}

TEST(Report, RealCasesPass) {
  for (const char* name : {"free-fall", "slopes", "conservation", "snow-press", "still-column"}) {
    const Result r = run_case(find_case(name), Options{}, folder(name));
    EXPECT_TRUE(r.passed()) << text_of(r);
    EXPECT_GT(r.particle_steps, 500000u);
  }
}

/// The page describes a scene as the scene does.
TEST(Report, ASetUpNamesMatterCellsAndWalls) {
  const auto set_up = [](const std::vector<std::string>& overrides, const char* name = "dam-break-1") {
    const model::Scene scene = built_in_scene(name, overrides);
    return set_up_of(scene, assemble(scene, "").world);
  };
  const std::string usual = set_up({});
  EXPECT_THAT(usual, HasSubstr("column (newtonian, sound 10.6 m/s) jittered, 8 particles a cell; 144 x 32 x 4 cells"));
  EXPECT_THAT(usual, HasSubstr("x_min, floor slip with skin friction; x_max, ceiling are open; the others slip"));
  EXPECT_THAT(set_up({"bodies.column.sample.pattern=lattice"}), HasSubstr("on a lattice"));
  EXPECT_THAT(set_up({"space.walls.all.type=stick"}, "bar-wave-elastic"), HasSubstr("walls stick"));
  EXPECT_THAT(set_up({}, "rigid-float"), HasSubstr("box (rigid, 500 kg/m^3)"));
  model::Scene weighed = built_in_scene("rigid-momentum");
  weighed.colliders.at(0).rigid->density.reset(), weighed.colliders.at(0).rigid->mass = 2;
  EXPECT_THAT(set_up_of(weighed, assemble(weighed, "").world), HasSubstr("cube (rigid, 2 kg)"));
  EXPECT_THAT(set_up({"space.periodic=[z]", "space.walls.all={type: separate, friction: 0.3}"}, "bar-wave-elastic"),
              HasSubstr("z_min, z_max periodic; the others separate with friction 0.3"));
}

TEST(Plot, ReferencesWearTheColorsOfTheirLines) {
  const auto strokes = [](const Plot& plot) {
    const std::string svg = svg_of(plot);
    std::vector<std::string> found;  // of the legend: what stands before each name
    for (const Curve& c : plot.curves) {
      const std::size_t text = svg.find(">" + c.name + "</text>"), at = svg.rfind("stroke=\"#", text);
      found.push_back(svg.substr(at + 8, 7));
    }
    return found;
  };
  const Curve a{"a", {0, 1}, {0, 1}}, b{"b", {0, 1}, {1, 2}}, a_ref{"a, exact", {0}, {0}, true},
      b_ref{"b, exact", {0}, {1}, true};
  const auto paired = strokes({"p", "", "x", "y", {a, a_ref, b, b_ref}}),
             one = strokes({"p", "", "x", "y", {a, b, a_ref}});
  EXPECT_EQ(paired[0], paired[1]);
  EXPECT_EQ(paired[2], paired[3]);
  EXPECT_NE(paired[0], paired[2]);
  EXPECT_NE(one[2], one[0]);
  EXPECT_NE(one[2], one[1]);
}

TEST(Plot, TheLegendHidesNoCurve) {
  // Points all over: only above them is room.
  Curve everywhere{"ours", {}, {}, true};
  for (int i = 0; i <= 40; ++i)
    for (int k = 0; k <= 40; ++k) everywhere.x.push_back(i), everywhere.y.push_back(k);
  const std::string svg = svg_of({"p", "a", "x", "y", {everywhere}});
  const std::regex box("<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"[^>]*opacity");
  const std::regex point("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::smatch m;
  ASSERT_TRUE(std::regex_search(svg, m, box));
  const double x = std::stod(m[1]), y = std::stod(m[2]), wide = std::stod(m[3]), high = std::stod(m[4]);
  int inside = 0, all = 0;
  for (std::sregex_iterator p(svg.begin(), svg.end(), point), end; p != end; ++p, ++all) {
    const double px = std::stod((*p)[1]), py = std::stod((*p)[2]);
    inside += px > x && px < x + wide && py > y && py < y + high;
  }
  EXPECT_EQ(all, 41 * 41 + 1);
  EXPECT_EQ(inside, 1) << "its own sign is in it, nothing else";
}

TEST(Plot, LeavesOutWhatIsNotFiniteAndEscapesText) {
  const std::string svg = svg_of({"p", "a < b & c", "x", "y", {{"ours", {0, 1, 2}, {0, NAN, 2}}}});
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

}  // namespace
}  // namespace dreampm::validate
