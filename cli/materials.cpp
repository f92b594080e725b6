#include <nlohmann/json.hpp>

#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

/// A number, the word that stands for it, or null for one that is derived.
Json default_of(const Param& p) {
  if (std::isnan(p.value)) return nullptr;
  if (p.words_only)
    for (const Word& w : p.words)
      if (w.value == p.value) return std::string(w.name);
  return p.value;
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
      parameters.push_back(one);
    }
    for (const Preset& p : m.presets) {
      Json values = Json::object();
      for (const Preset::Value& v : p.values) values[std::string(v.key)] = v.value;
      presets.push_back({{"name", std::string(p.name)}, {"source", std::string(p.source)}, {"values", values}});
    }
    list.push_back({{"name", std::string(m.name)},
                    {"help", std::string(m.help)},
                    {"liquid", m.liquid},
                    {"parameters", parameters},
                    {"presets", presets}});
  }
  fmt::print("{}\n", list.dump(2));
}

void print_text() {
  for (const MaterialInfo& m : material_infos()) {
    fmt::print("{}: {}\n", m.name, m.help);
    fmt::print("  {:<18}{:<8}{:>10}{:>10}{:>10}  {}\n", "parameter", "unit", "default", "min", "max", "");
    for (const Param& p : m.params) {
      const Json value = default_of(p);
      const std::string text = value.is_null()     ? "derived"
                               : value.is_string() ? value.get<std::string>()
                                                   : fmt::format("{:.6g}", p.value);
      fmt::print("  {:<18}{:<8}{:>10}{:>10.6g}{:>10.6g}  {}\n", p.key, p.unit, text, p.min, p.max, p.help);
    }
    for (const Preset& p : m.presets) {
      std::string values;
      for (const Preset::Value& v : p.values)
        values += fmt::format("{}{} {:.6g}", values.empty() ? "" : ", ", v.key, v.value);
      fmt::print("  preset {:<11}{} ({})\n", p.name, values, p.source);
    }
    fmt::print("\n");
  }
}

}  // namespace

void add_materials(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false);
  CLI::App* verb =
      add_verb(app, "materials", "List the materials with their parameters and presets", "dreampm materials --json");
  verb->add_flag("--json", *json, "print JSON");
  verb->callback([json, &action] {
    action = [json] {
      *json ? print_json() : print_text();
      return 0;
    };
  });
}

}  // namespace dreampm::cli
