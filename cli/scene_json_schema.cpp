// The scene format as a JSON Schema. It refuses nothing that the parser accepts; what depends on
// other values (a key that only one type of wall has, min below max) the parser alone checks.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "dreampm/version.h"
#include "schema.h"

namespace dreampm::cli {
namespace {
using scene::KeyInfo;
using scene::MapInfo;
using scene::ValueInfo;
using SchemaJson = nlohmann::ordered_json;

SchemaJson default_json(const scene::YamlNode& n) {
  if (n.kind == scene::YamlNode::Kind::list) {
    SchemaJson list = SchemaJson::array();
    for (const scene::YamlNode& item : n.items) list.push_back(default_json(item));
    return list;
  }
  if (n.quoted) return n.text;
  if (n.text == "true" || n.text == "false") return n.text == "true";
  double v = 0;
  const char* end = n.text.data() + n.text.size();
  const auto [stop, error] = std::from_chars(n.text.data(), end, v);
  if (error != std::errc{} || stop != end) return n.text;
  return v == std::floor(v) && std::abs(v) < 1e15 ? SchemaJson(static_cast<std::int64_t>(v)) : SchemaJson(v);
}

/// The unit of numbers, of lists of them, and of values by time.
std::string unit_of(const ValueInfo& value) {
  if (const auto* n = std::get_if<scene::NumberInfo>(&value.form)) return n->range.unit;
  if (const auto* l = std::get_if<scene::ListInfo>(&value.form)) return unit_of(l->item[0]);
  if (const auto* e = std::get_if<scene::EitherInfo>(&value.form)) return unit_of(e->of[0]);
  return {};
}

class SchemaWriter {
 public:
  SchemaJson whole() {
    SchemaJson root{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                    {"title", fmt::format("A scene of DreaMPM {}", version)}};
    root.update(map(scene::scene_info()));
    root["$defs"] = defs_;
    return root;
  }

 private:
  SchemaJson of(const ValueInfo& value) {
    return std::visit([this](const auto& form) { return write(form); }, value.form);
  }
  SchemaJson write(const std::monostate&) { return true; }
  SchemaJson write(const scene::NumberInfo& n) {
    SchemaJson json{{"type", "number"}};
    if (std::isfinite(n.range.min)) json[n.range.open_min ? "exclusiveMinimum" : "minimum"] = n.range.min;
    if (std::isfinite(n.range.max)) json[n.range.open_max ? "exclusiveMaximum" : "maximum"] = n.range.max;
    return json;
  }
  SchemaJson write(const scene::WholeInfo& w) {
    SchemaJson json{{"type", "integer"}, {"minimum", w.min}};
    if (w.max < std::numeric_limits<std::int64_t>::max()) json["maximum"] = w.max;
    return json;
  }
  SchemaJson write(const scene::FlagInfo&) { return {{"type", "boolean"}}; }
  SchemaJson write(const scene::TextInfo& t) {
    // The parser takes any scalar as it is typed: 2026 and true are names, too. A pattern is for
    // strings alone.
    SchemaJson json{{"type", SchemaJson::array({"string", "number", "boolean"})}};
    if (!t.pattern.empty()) json["pattern"] = t.pattern;
    return json;
  }
  SchemaJson write(const scene::WordInfo& w) { return {{"enum", w.words}}; }
  SchemaJson write(const scene::ListInfo& l) {
    SchemaJson json{{"type", "array"}, {"items", of(l.item[0])}, {"minItems", l.min}};
    if (l.max != scene::any_length) json["maxItems"] = l.max;
    return json;
  }
  /// One that stands in several places is written once, under its name.
  SchemaJson write(const scene::MapOf& m) {
    if (m.name.empty()) return map(m.make());
    std::string name = (overlay_ ? "part-of-" : "") + m.name;
    std::replace(name.begin(), name.end(), ' ', '-');
    if (!defs_.contains(name)) {
      defs_[name] = true;  // it may hold itself
      SchemaJson json = map(m.make());
      defs_[name] = std::move(json);
    }
    return {{"$ref", "#/$defs/" + name}};
  }
  SchemaJson write(const scene::NamesInfo& n) {
    return {{"type", "object"},
            {"propertyNames", {{"pattern", scene::good_name_pattern}}},
            {"additionalProperties", of(n.each[0])}};
  }
  SchemaJson write(const scene::EitherInfo& e) {
    SchemaJson any = SchemaJson::array();
    for (const ValueInfo& one : e.of) any.push_back(of(one));
    return {{"anyOf", any}};
  }
  SchemaJson write(const scene::OverlayInfo& o) {
    const bool before = std::exchange(overlay_, true);
    SchemaJson json = map(o.of());
    overlay_ = before;
    return json;
  }

  SchemaJson key(const KeyInfo& k) {
    SchemaJson json = of(k.value);
    if (!json.is_object()) json = SchemaJson::object();
    const std::string unit = unit_of(k.value);
    json["description"] = k.meaning + (unit.empty() ? "" : fmt::format(" [{}]", unit)) +
                          (k.only.empty() ? "" : fmt::format(" Only for {}.", k.only));
    if (k.by_default) json["default"] = default_json(*k.by_default);
    return json;
  }
  void put_keys(SchemaJson& properties, const std::vector<KeyInfo>& keys) {
    for (const KeyInfo& k : keys) properties[k.key] = key(k);
  }

  SchemaJson map(const MapInfo& info) {
    if (!info.types.empty()) return overlay_ ? any_type(info) : by_type(info);
    SchemaJson properties = SchemaJson::object(), required = SchemaJson::array();
    put_keys(properties, info.keys);
    for (const KeyInfo& k : info.keys)
      if (k.required && k.unless.empty()) required.push_back(k.key);
    SchemaJson json{{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
    if (overlay_) return json;
    if (!required.empty()) json["required"] = required;
    add_rules(json, info);
    return json;
  }

  static void add_rules(SchemaJson& json, const MapInfo& info) {
    for (const auto& group : info.one_of) json["oneOf"].push_back({{"required", group}});
    for (const std::string& k : info.at_least_one) json["anyOf"].push_back({{"required", {k}}});
    for (const std::string& a : info.together)
      for (const std::string& b : info.together)
        if (a != b) json["dependentRequired"][a].push_back(b);
    for (const scene::Alternative& a : scene::alternatives()) {
      if (!info.find(a.left[0]) || !info.find(a.right[0])) continue;
      for (const std::string_view l : a.left)
        for (const std::string_view r : a.right) json["allOf"].push_back(not_both(l, r));
    }
  }
  static SchemaJson not_both(std::string_view a, std::string_view b) {
    return {{"not", {{"required", SchemaJson::array({std::string(a), std::string(b)})}}}};
  }

  SchemaJson by_type(const MapInfo& info) {
    SchemaJson types = SchemaJson::array();
    for (const MapInfo::Type& t : info.types) {
      MapInfo one{info.keys};
      one.keys.insert(one.keys.end(), t.keys.begin(), t.keys.end());
      SchemaJson json = map(one);
      json["properties"]["type"] = {{"const", t.name}, {"description", t.about}};
      json["required"].push_back("type");
      json["title"] = t.name;
      types.push_back(std::move(json));
    }
    return {{"type", "object"}, {"required", {"type"}}, {"oneOf", types}};
  }

  /// Returns the schema of a map of any type, with the keys of all types.
  SchemaJson any_type(const MapInfo& info) {
    SchemaJson properties = SchemaJson::object(), types = SchemaJson::array();
    put_keys(properties, info.keys);
    for (const MapInfo::Type& t : info.types) {
      types.push_back(t.name);
      for (const KeyInfo& k : t.keys) {
        SchemaJson one = of(k.value);
        SchemaJson& all = properties[k.key]["anyOf"];
        if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(std::move(one));
      }
    }
    properties["type"] = {{"enum", types}};
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  }

  bool overlay_ = false;  ///< true if keys are laid over others, so that none is required
  SchemaJson defs_ = SchemaJson::object();
};

}  // namespace

std::string scene_json_schema() { return SchemaWriter().whole().dump(2) + "\n"; }

}  // namespace dreampm::cli
