// One tree laid over another: variants and --set.
#include <algorithm>

#include "dreampm/scene/tree.h"

namespace dreampm::scene {
namespace {

using Path = std::vector<std::string_view>;

bool contains(const std::vector<std::string_view>& words, std::string_view w) {
  return std::find(words.begin(), words.end(), w) != words.end();
}

/// Removes from `base` the keys that `key` stands instead of.
void drop_alternatives(YamlNode& base, std::string_view key, std::string_view in) {
  for (const Alternative& a : alternatives()) {
    if (!a.in.empty() && a.in != in) continue;
    const auto* others = contains(a.left, key) ? &a.right : contains(a.right, key) ? &a.left : nullptr;
    if (others) std::erase_if(base.entries, [&](const Entry& e) { return contains(*others, e.key); });
  }
}

std::string_view form_of(const YamlNode& shape) {
  for (const Entry& e : shape.entries)
    if (std::find(shape_forms().begin(), shape_forms().end(), e.key) != shape_forms().end()) return e.key;
  return {};
}

/// A hollow of another form takes no key of the one before it; the keys of the container stay.
void drop_hollow(YamlNode& base, const YamlNode& over) {
  const std::string_view form = form_of(over);
  if (form.empty() || form == form_of(base)) return;
  std::erase_if(base.entries, [](const Entry& e) {
    return std::find(container_keys().begin(), container_keys().end(), e.key) == container_keys().end();
  });
}

/// Is `over` a thing of another kind, of which no key of `base` may remain?
bool replaces(const YamlNode& base, const YamlNode& over, const Path& path) {
  const std::size_t n = path.size();
  if (n >= 1 && path[n - 1] == "shape") {
    const std::string_view form = form_of(over);
    return !form.empty() && form != form_of(base);
  }
  // A preset has a type.
  if (n >= 2 && path[n - 2] == "looks" &&
      ((base.find("preset") && over.find("type")) || (base.find("type") && over.find("preset"))))
    return true;
  const bool typed = n >= 2 && contains({"materials", "looks", "walls", "fields", "probes"}, path[n - 2]);
  const YamlNode* before = base.find("type");
  const YamlNode* after = over.find("type");
  return typed && before && after && before->text != after->text;
}

void merge_at(YamlNode& base, const YamlNode& over, Path& path) {
  if (!base.is_map() || !over.is_map() || replaces(base, over, path)) {
    base = over;
    return;
  }
  if (!path.empty() && path.back() == "container") drop_hollow(base, over);
  for (const Entry& e : over.entries) drop_alternatives(base, e.key, path.empty() ? std::string_view{} : path.back());
  for (const Entry& e : over.entries) {
    if (YamlNode* old = base.find(e.key)) {
      path.push_back(e.key);
      merge_at(*old, e.value, path);
      path.pop_back();
    } else {
      base.entries.push_back(e);
    }
  }
}

}  // namespace

const std::vector<Alternative>& alternatives() {
  static const std::vector<Alternative> table{
      {"time", {"frames"}, {"seconds"}},
      {"time", {"dt"}, {"cfl"}},
      {"time", {"dt"}, {"dt_max"}},
      {"shape", {"fit"}, {"scale"}},
      {"container", {"fit"}, {"scale"}},
      {"box", {"min", "max"}, {"size"}},
      {"camera", {"from", "to"}, {"fit", "azimuth", "elevation", "fill"}},
      {"camera", {"aperture"}, {"fstop"}},
      {"light", {"sky"}, {"environment"}},
      {"", {"bulk_modulus"}, {"max_compression"}},
  };
  return table;
}

const std::vector<std::string>& shape_forms() {
  static const std::vector<std::string> names{"box",          "sphere",    "cylinder",   "plane",
                                              "mesh",         "points",    "union",      "difference",
                                              "intersection", "container", "heightfield"};
  return names;
}

const std::vector<std::string>& container_keys() {
  static const std::vector<std::string> names{"wall", "open", "up", "cut", "form"};
  return names;
}

void merge(YamlNode& base, const YamlNode& over) {
  Path path;
  merge_at(base, over, path);
}

}  // namespace dreampm::scene
