// The page of the scene format: a table for every map.
#include <fmt/ranges.h>

#include <cctype>
#include <set>

#include "schema.h"

namespace dreampm::cli {
namespace {
using scene::KeyInfo;
using scene::MapInfo;
using scene::ValueInfo;

constexpr const char* page_head = R"(# The scene format

Made by `dreampm schema --markdown` from the tables that read scenes; a test compares both. A scene
is a YAML file. Units are SI, angles degrees, the axis y points up. A key that is not in these
tables, or a value out of its range, is an error with its line and column: `dreampm check SCENE`
lists all of them. `--set PATH=VALUE` gives a key another value, as in `--set space.spacing=0.02`.
With `dreampm schema --json` editors complete and check scenes ([how](../howto/editor.md)).

```yaml
dreampm: 1
name: drop
space: {max: [1, 1.2, 0.6], spacing: 0.02}
materials:
  water: {type: newtonian, preset: water}
bodies:
  drop: {material: water, shape: {sphere: {radius: 0.15}, center: [0.5, 0.8, 0.3]}}
```

NAME stands for a name that the scene gives: letters, digits, `-` and `_`, beginning with a letter
or digit, at most 64. A list of 3 numbers is `[x, y, z]`.
)";

/// A map of the page, with its heading.
struct PagePart {
  std::string name, about;
  MapInfo map;
};

/// Finds every map of the scene, each once: those with a place of their own by their paths, then
/// those that stand in several places.
class PageParts {
 public:
  PageParts() {
    add("The scene", "", scene::scene_info(), "");
    while (!waiting_.empty()) {
      std::vector<PagePart> now = std::move(waiting_);
      waiting_.clear();
      for (const PagePart& part : now) add(part.name, part.about, part.map, part.name);
    }
  }
  const std::vector<PagePart>& list() const { return list_; }

 private:
  void add(const std::string& name, const std::string& about, const MapInfo& map, const std::string& path) {
    list_.push_back({name, about, map});
    for (const KeyInfo& k : map.keys) look(k.value, path.empty() ? k.key : path + "." + k.key, k.meaning);
    for (const MapInfo::Type& type : map.types)
      for (const KeyInfo& k : type.keys) look(k.value, path + "." + k.key, k.meaning);
  }
  void look(const ValueInfo& value, const std::string& path, const std::string& about) {
    std::visit(Overloaded{[&](const scene::MapOf& m) {
                            if (!seen_.insert(m.name.empty() ? path : m.name).second) return;
                            if (m.name.empty())
                              add(path, about, m.make(), path);
                            else
                              waiting_.push_back({m.name, "", m.make()});
                          },
                          [&](const scene::NamesInfo& n) { look(n.each[0], path + ".NAME", about); },
                          [&](const scene::ListInfo& l) { look(l.item[0], path + "[]", about); },
                          [&](const scene::EitherInfo& e) {
                            for (const ValueInfo& one : e.of) look(one, path, about);
                          },
                          [](const auto&) {}},
               value.form);
  }

  std::vector<PagePart> list_, waiting_;
  std::set<std::string> seen_;
};

std::string link_to(const std::string& name) {
  std::string anchor;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ')
      anchor += '-';
  return fmt::format("[{}](#{})", name, anchor);
}

std::string code_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += fmt::format("{}`{}`", text.empty() ? "" : ", ", w);
  return text;
}

/// " [m], above 0"
std::string range_words(scene::Range range) {
  const std::string unit = *range.unit ? fmt::format(" [{}]", range.unit) : "";
  range.unit = "";
  const std::string limits = range.text();
  return unit + (limits.empty() ? "" : ", " + limits);
}

std::string takes_text(const ValueInfo& value, const std::string& path);

std::string list_text(const scene::ListInfo& list, const std::string& path) {
  if (const auto* n = std::get_if<scene::NumberInfo>(&list.item[0].form); n && list.min == list.max)
    return fmt::format("{} numbers{}", list.min, range_words(n->range));
  const std::string item = takes_text(list.item[0], path + "[]");
  if (list.min == list.max) return fmt::format("{} of: {}", list.min, item);
  return list.min > 1 ? fmt::format("list of {} or more: {}", list.min, item) : fmt::format("list: {}", item);
}

std::string whole_text(const scene::WholeInfo& w) {
  if (w.min == w.max) return std::to_string(w.min);
  if (w.max == std::numeric_limits<std::int64_t>::max()) return fmt::format("whole number, at least {}", w.min);
  return fmt::format("whole number, {} to {}", w.min, w.max);
}

std::string takes_text(const ValueInfo& value, const std::string& path) {
  return std::visit(
      Overloaded{[](const std::monostate&) { return std::string(); },
                 [](const scene::NumberInfo& n) { return "number" + range_words(n.range); },
                 [](const scene::WholeInfo& w) { return whole_text(w); },
                 [](const scene::FlagInfo&) { return std::string("`true`, `false`"); },
                 [](const scene::TextInfo& t) { return t.what; },
                 [](const scene::WordInfo& w) { return code_list(w.words); },
                 [&](const scene::ListInfo& l) { return list_text(l, path); },
                 [&](const scene::MapOf& m) { return link_to(m.name.empty() ? path : m.name); },
                 [&](const scene::NamesInfo& n) { return "names: " + takes_text(n.each[0], path + ".NAME"); },
                 [&](const scene::EitherInfo& e) {
                   std::string text;
                   for (const ValueInfo& one : e.of) text += (text.empty() ? "" : "; or ") + takes_text(one, path);
                   return text;
                 },
                 [](const scene::OverlayInfo& o) { return o.what; }},
      value.form);
}

std::string default_words(const KeyInfo& k) {
  if (k.required) return k.unless.empty() ? "**required**" : "**required** unless " + k.unless;
  if (!k.by_default) return "";
  scene::YamlNode map = scene::YamlNode::map();
  map.put("k", *k.by_default);
  const std::string text = scene::write_yaml(map);  // "k: VALUE\n"
  return "`" + text.substr(3, text.size() - 4) + "`";
}

std::string key_rows(const std::vector<KeyInfo>& keys, const std::string& path) {
  std::string text = "| key | takes | default | meaning |\n|---|---|---|---|\n";
  for (const KeyInfo& k : keys)
    text += fmt::format("| `{}` | {} | {} | {}{} |\n", k.key,
                        takes_text(k.value, path.empty() ? k.key : path + "." + k.key), default_words(k), k.meaning,
                        k.only.empty() ? "" : fmt::format(" Only for {}.", k.only));
  return text;
}

std::string rules_of(const MapInfo& map) {
  std::string text;
  if (!map.one_of.empty()) {
    std::string groups;
    for (const auto& group : map.one_of) {
      std::string keys;
      for (const std::string& key : group) keys += fmt::format("{}`{}`", keys.empty() ? "" : " with ", key);
      groups += (groups.empty() ? "" : ", ") + keys;
    }
    text += fmt::format("\nExactly one of: {}.\n", groups);
  }
  if (!map.at_least_one.empty()) text += fmt::format("\nAt least one of: {}.\n", code_list(map.at_least_one));
  if (!map.together.empty()) text += fmt::format("\nAll or none of: {}.\n", code_list(map.together));
  for (const scene::Alternative& a : scene::alternatives()) {
    const auto known = [&](std::string_view key) { return map.find(key) != nullptr; };
    if (known(a.left[0]) && known(a.right[0]) && map.one_of.empty())
      text += fmt::format("\n`{}` excludes `{}`.\n", fmt::join(a.left, "`, `"), fmt::join(a.right, "`, `"));
  }
  return text;
}

std::string part_text(const PagePart& part) {
  const std::string path = part.name == "The scene" ? "" : part.name;
  std::string text = fmt::format("\n## {}\n", part.name);
  if (!part.about.empty()) text += fmt::format("\n{}\n", part.about);
  std::vector<KeyInfo> keys = part.map.keys;
  if (!part.map.types.empty()) {
    std::vector<std::string> types;
    for (const MapInfo::Type& t : part.map.types) types.push_back(t.name);
    KeyInfo type{"type", scene::word_info(types), "What it is; each type has keys of its own, below."};
    type.required = true;
    keys.insert(keys.begin(), std::move(type));
  }
  text += "\n" + key_rows(keys, path);
  text += rules_of(part.map);
  for (const MapInfo::Type& t : part.map.types)
    text += fmt::format("\n### type: {}\n\n{}\n\n{}{}", t.name, t.about, key_rows(t.keys, path), rules_of({t.keys}));
  return text;
}

}  // namespace

std::string scene_page() {
  const PageParts parts;
  std::string page = page_head;
  for (const PagePart& part : parts.list()) page += part_text(part);
  return page;
}

}  // namespace dreampm::cli
