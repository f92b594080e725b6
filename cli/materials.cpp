#include <nlohmann/json.hpp>

#include "dreampm/physics/dt.h"
#include "dreampm/physics/materials.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

// The setting for which the typical step is given.
constexpr double typical_dx = 0.01, typical_cfl = 0.5, typical_fall = 1;
const double typical_speed = std::sqrt(2 * 9.81 * typical_fall);

/// A set of values with what follows from it.
struct Kind {
  std::string name, source;  ///< a preset's; "defaults" without a source
  std::vector<Preset::Value> given;
  MaterialFacts facts;
  double density, dt;
};

Kind kind_of(const MaterialInfo& m, const Preset* preset) {
  Kind kind;
  kind.name = preset ? std::string(preset->name) : "defaults";
  Values values;
  if (preset) {
    kind.source = preset->source;
    kind.given.assign(preset->values.begin(), preset->values.end());
    for (const Preset::Value& v : preset->values) values.set(v.key, v.value);
  }
  values.with_defaults(m.params);
  kind.density = values["density"];
  // The bulk modulus as a run derives it: the fastest matter compresses it by max_compression.
  if (m.find("bulk_modulus") && !values.has("bulk_modulus"))
    values.set("bulk_modulus", kind.density * typical_speed * typical_speed / values["max_compression"]);
  kind.facts = facts_of(m, values);
  kind.dt = stable_dt(typical_cfl, typical_dx,
                      {typical_speed, kind.facts.sound_speed, shock_wave_speed(m.name, values, typical_speed),
                       kind.facts.kinematic_viscosity},
                      1e30)
                .dt;
  return kind;
}

std::vector<Kind> kinds_of(const MaterialInfo& m) {
  std::vector<Kind> kinds{kind_of(m, nullptr)};
  for (const Preset& p : m.presets) kinds.push_back(kind_of(m, &p));
  return kinds;
}

std::string conditions() {
  return fmt::format(
      "dt: a typical step at cfl {:g} and dx = {:g} m for matter at {:.3g} m/s (a fall of {:g} m), from which a "
      "bulk modulus is derived too; impacts count where that is faster than 0.3 of its sound",
      typical_cfl, typical_dx, typical_speed, typical_fall);
}

std::string given_text(const Kind& k) {
  std::string text;
  for (const Preset::Value& v : k.given) text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", v.key, v.value);
  return text;
}

/// A number, the word that stands for it, or null for one that is derived.
Json default_of(const Param& p) {
  if (std::isnan(p.value)) return nullptr;
  if (p.words_only)
    for (const Word& w : p.words)
      if (w.value == p.value) return std::string(w.name);
  return p.value;
}

std::string default_text(const Param& p) {
  const Json value = default_of(p);
  return value.is_null() ? "derived" : value.is_string() ? value.get<std::string>() : fmt::format("{:.6g}", p.value);
}

/// The words of a parameter, each within `mark`.
std::string words_text(const Param& p, std::string_view mark = "") {
  std::string words;
  for (const Word& w : p.words) words += fmt::format("{}{}{}{}", words.empty() ? "" : ", ", mark, w.name, mark);
  return words;
}

/// "0 to 1000", and the words that are accepted too, or instead.
std::string range_text(const Param& p) {
  const std::string words = words_text(p, "`");
  if (p.words_only) return words;
  return fmt::format("{:.6g} to {:.6g}{}{}", p.min, p.max, words.empty() ? "" : ", ", words);
}

Json json_of(const Kind& k) {
  Json values = Json::object();
  for (const Preset::Value& v : k.given) values[std::string(v.key)] = v.value;
  return {{"name", k.name},
          {"source", k.source},
          {"values", values},
          {"sound_speed", k.facts.sound_speed},
          {"kinematic_viscosity", k.facts.kinematic_viscosity},
          {"poissons_ratio", k.facts.poissons_ratio},
          {"dt", k.dt},
          {"dt_for", {{"dx", typical_dx}, {"cfl", typical_cfl}, {"speed", typical_speed}}}};
}

/// How a slider shows a parameter; null: by its key and its range.
Json slider_of(const Param& p) {
  Json slider;
  if (!p.slider.label.empty()) slider["label"] = std::string(p.slider.label);
  if (!std::isnan(p.slider.min)) slider["min"] = p.slider.min;
  if (!std::isnan(p.slider.max)) slider["max"] = p.slider.max;
  return slider;
}

void print_json() {
  Json list = Json::array();
  for (const MaterialInfo& m : material_infos()) {
    Json parameters = Json::array(), presets = Json::array();
    for (const Param& p : m.params) {
      Json words = Json::array();
      for (const Word& w : p.words) words.push_back(std::string(w.name));
      Json one{{"key", std::string(p.key)},
               {"unit", std::string(p.unit)},
               {"default", default_of(p)},
               {"min", p.min},
               {"max", p.max},
               {"help", std::string(p.help)}};
      if (!words.empty()) one["words"] = words;
      if (const Json slider = slider_of(p); !slider.is_null()) one["slider"] = slider;
      parameters.push_back(one);
    }
    for (const Preset& p : m.presets) presets.push_back(json_of(kind_of(m, &p)));
    list.push_back({{"name", std::string(m.name)},
                    {"help", std::string(m.help)},
                    {"liquid", m.liquid},
                    {"parameters", parameters},
                    {"defaults", json_of(kind_of(m, nullptr))},
                    {"presets", presets}});
  }
  fmt::print("{}\n", list.dump(2));
}

void print_text() {
  for (const MaterialInfo& m : material_infos()) {
    fmt::print("{}: {}\n", m.name, m.help);
    fmt::print("  {:<22}{:<8}{:>10}{:>12}{:>12}  {}\n", "parameter", "unit", "default", "min", "max", "");
    for (const Param& p : m.params) {
      const std::string range = p.words_only ? words_text(p) : fmt::format("{:.6g}{:>12.6g}", p.min, p.max);
      fmt::print("  {:<22}{:<8}{:>10}{:>24}  {}\n", p.key, p.unit, default_text(p), range, p.help);
    }
    for (const Kind& k : kinds_of(m)) {
      const double nu = k.facts.kinematic_viscosity;
      fmt::print("  {:<22}sound {:.3g} m/s, {}Poisson's ratio {:.3g}, dt {:.2g} s\n",
                 k.source.empty() ? k.name : "preset " + k.name, k.facts.sound_speed,
                 nu > 0 ? fmt::format("kinematic viscosity {:.3g} m^2/s, ", nu) : "", k.facts.poissons_ratio, k.dt);
      if (!k.source.empty()) fmt::print("    {}\n    ({})\n", given_text(k), k.source);
    }
    fmt::print("\n");
  }
  fmt::print("{}\n", conditions());
}

/// A row of pictures, one a preset; those of docs/ are of this tree's own materials.
void print_pictures(const MaterialInfo& m) {
  if (!OwnMaterials::with(m.name, []<class M>() {})) return;
  std::string names = "|", rule = "|", pictures = "|";
  const auto add = [&](std::string_view name, const std::string& file) {
    names += fmt::format(" {} |", name);
    rule += "---|";
    pictures += fmt::format(" ![{}](../images/materials/{}.jpg) |", name, file);
  };
  for (const Preset& p : m.presets) add(p.name, fmt::format("{}-{}", m.name, p.name));
  if (m.presets.empty()) add(m.name, std::string(m.name));
  fmt::print("{}\n{}\n{}\n\n", names, rule, pictures);
}

// Sources of each preset, and values that could not be read.
constexpr std::string_view where_from = R"(
## Where the presets come from

Each figure was compared with the paper, its abstract or a page that quotes it; where none was at hand, that is said.

- water: 998.2 kg/m^3 and 1.002 mPa s at 20 C (M. Chaplin, Water Structure and Science, says the same).
- oil: 84.0 mPa s at 20 C stands in the older editions of the handbook, in its table of the viscosity of liquids; it was not at hand, the encyclopaedia
  Wikipedia has the same figure. What was read fits: the thickest of the vegetable oils that Diamante and Lan measured (2014, J. Food Process. 234583)
  has 39.8 mPa s at 38 C; with 30 kJ/mol, the most they found, 81 at 20 C. The Codex wants 0.910 to 0.916 of water's density at 20 C; 914 kg/m^3 is the
  0.9137 of an oil mill's table (Las Valdesas).
- honey: five honeys of the Caatinga in Brazil, Newtonian, 1.90 to 8.55 Pa s at 20 C with 17.45 to 21.5 % of water (Santos et al. 2014, abstract); the
  preset is the thickest. 1,423 kg/m^3 at 15 % of water, 1,417 at 18 % (beekeepers' club of Pella), so 1,418 at 17.45 %. Honey varies: clover honey with
  16 % has 19 Pa s at 20 C (the same club); seven with 14.7 to 18 % have 1.76 to 253 Pa s between 40 and 10 C (J. Food Eng. 75:43, 2006). `viscosity` is
  yours to set.
- jelly: stiffness falls as a power of the water, from 277 kPa at 2:1 to 4.34 kPa at 20:1 (Bonavia 2025), so 10 kPa is 12.6:1, 7 % of gelatine.
- rubber: 0.95 g/cm^3, G = 0.5 MPa (MatWeb, natural rubber, vulcanized); 1 to 5 MPa (Netzsch, NR).
- silicone: 1.32 to 2.97 MPa as it is cured at 25 to 200 C (Johnston et al.); 1.03 g/cm^3.
- natural_rubber: Treloar's points of 1944 (in felupe's documentation) give G = 0.36 to 0.43 MPa up to a stretch of 1.4; density 0.93.
- snow: all six values of `packed` are quoted as those of the paper's table 2 by programs that follow it (Azmisov/snow, for one). The paper's comparison of
  snowballs varies E (0.48e5 Pa), hardening (5), critical compression (0.019) and critical stretch (0.005): `powdery` and `slushy` take those.
- sand: 100 to 250 tons per square foot for loose sand (USACE), nu 0.30 to 0.35 (GOST 12248-96). Das's table, 30 to 35 degrees for loose angular grains,
  was not at hand. 1,600 kg/m^3 is quartz, 2,650, that fills six tenths of the space.
- wet sand: 1.72 kPa and 29 degrees, sandy loam with 15 % of water; 1.38 kPa and 38 degrees with 22 % (Wong's table, in a program for vehicles on soft
  ground). The table's one other sand, LETE, has 1.3 kPa and 31.1 degrees, but no water content, and its dry sand 1.04 kPa, so that is no wet sand for
  certain. The loam's cohesion is one of wet fine sand: bridges of water pull with 2 pi gamma R, about 6 at a grain (Richefeu et al. 2006, Stress
  transmission in wet granular materials), which makes tan(phi) Phi Z gamma/d: 1.72 kPa for d = 0.085 mm, with Phi = 0.6 solid, Z = 6 and gamma =
  0.073 N/m. 1,840 kg/m^3 is dry sand with 15 % more.
- mud: 0.181 exp(25.7 C) dyn/cm^2 and 0.036 exp(22.1 C) poise, C the sediment's volume fraction (Aspen Pit 1 of O'Brien and Julien, in FLO-2D's
  manual). 1,580 kg/m^3: C = 0.35 of 2,650 in water.
- toothpaste: the Herschel-Bulkley fit with the least standard error (9.6) of the ten pastes in Cole's table 4.4, but for one that is next to
  a liquid. Others there have 36 to 133 Pa, 80 to 341 Pa s^n and n 0.09 to 0.31. 1,300 kg/m^3 is what toothpastes usually weigh.
- lava: Etna's first lava of 1974 has 2,210 kg/m^3, 37 % crystals, 1080 C and about 10^3 Pa s (Lormand et al. 2020, abstract). Yield stress 6500 C^2.85
  Pa of a part C of crystals (Ryerson et al., in PyFLOWGO): 382 Pa. Lavas differ: the second of 1974 has 10^5 Pa s, and 9,400 +- 1,500 was measured on one
  that a model of 45 % crystals and 25 to 35 % bubbles fits (Harris and Allen 2008, J. Geophys. Res. 113:B09212).

Densities of mixtures (jelly, mud, wet sand) follow from their parts. Stiffness of pastes before they yield and of wet sand (that of dry), and nu below
0.5 where a solid hardly changes its volume, are ours, for the sake of the step.
)";

void print_markdown() {
  fmt::print(R"(# Materials

Made by `dreampm materials --markdown`; a test holds it to that. In a scene: `NAME: {{type: TYPE, preset: PRESET, key: value}}`;
own keys win over the preset's.

Beside each preset stands what it comes to: sound speed, kinematic viscosity (- where none bounds the step), Poisson's
ratio of small strains. {}.

Every picture shows the same ball, thrown down at 2 m/s onto a post (lava is laid there: it takes a second), each at a
moment of its own: the variants of `scenes/materials/drop.yaml`. `tools/material_pictures` makes them again.
)",
             conditions());
  for (const MaterialInfo& m : material_infos()) {
    fmt::print("\n## {}\n\nIt is {}{}.\n\n", m.name, m.help,
               m.liquid ? " (a liquid: its density is measured on the grid)" : "");
    print_pictures(m);
    fmt::print("| parameter | unit | default | range | |\n|---|---|---|---|---|\n");
    for (const Param& p : m.params)
      fmt::print("| `{}` | {} | {} | {} | {} |\n", p.key, p.unit, default_text(p), range_text(p), p.help);
    fmt::print("\n| preset | values | sound, m/s | viscosity, m^2/s | Poisson | dt, s | source |\n");
    fmt::print("|---|---|---|---|---|---|---|\n");
    for (const Kind& k : kinds_of(m))
      fmt::print("| {} | {} | {:.3g} | {} | {:.3g} | {:.2g} | {} |\n",
                 k.source.empty() ? "(defaults)" : "`" + k.name + "`", given_text(k), k.facts.sound_speed,
                 k.facts.kinematic_viscosity > 0 ? fmt::format("{:.3g}", k.facts.kinematic_viscosity) : "-",
                 k.facts.poissons_ratio, k.dt, k.source);
  }
  fmt::print("{}", where_from);
}

}  // namespace

void add_materials(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false), markdown = std::make_shared<bool>(false);
  CLI::App* verb =
      add_verb(app, "materials", "List the materials with their parameters and presets", "dreampm materials --json");
  CLI::Option* flag = verb->add_flag("--json", *json, "print JSON");
  verb->add_flag("--markdown", *markdown, "print the page docs/reference/materials.md")->excludes(flag);
  verb->callback([json, markdown, &action] {
    action = [json, markdown] {
      *json ? print_json() : *markdown ? print_markdown() : print_text();
      return 0;
    };
  });
}

}  // namespace dreampm::cli
