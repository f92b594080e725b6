// A YAML document as a plain tree in which every value knows where it was written.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/scene/problem.h"

namespace dreampm::scene {

struct Entry;

struct YamlNode {
  enum class Kind { null, scalar, list, map } kind = Kind::null;
  std::string text;     ///< scalar
  bool quoted = false;  ///< scalar in quotes or a block: a text even if it looks like a number
  std::vector<YamlNode> items;
  std::vector<Entry> entries;  ///< in the order of the file
  Place at;

  static YamlNode scalar(std::string text, bool quoted = false);
  static YamlNode list(std::vector<YamlNode> items);
  static YamlNode map();
  bool is_map() const { return kind == Kind::map; }
  const YamlNode* find(std::string_view key) const;
  YamlNode* find(std::string_view key);
  /// Appends, without looking for the key.
  void put(std::string key, YamlNode value);
  /// "a list", "a map", "nothing" or the text itself in quotes: for messages.
  std::string describe() const;
};

struct Entry {
  std::string key;
  Place at;
  YamlNode value;
};

/// Parses one YAML document. Reports what YAML itself forbids and what scenes do not allow: tabs,
/// several documents, `<<`, tags, duplicate keys, keys that are not words, too deep or too large a
/// tree. The tree holds what could be read.
YamlNode read_yaml(std::string_view text, const std::string& file, Problems& problems);

/// The value of PATH=VALUE as a tree of maps: every place in it is that argument, after `source`.
YamlNode read_override(const std::string& argument, const std::string& source, Problems& problems);

/// Lays `over` on `base`: maps are merged key by key, anything else is replaced. A key that stands
/// instead of others (`seconds` of `frames`, `dt` of `cfl` ...) replaces them; so does a shape of
/// another form, and a material, wall or look of another type.
void merge(YamlNode& base, const YamlNode& over);

/// Key names that exclude each other within a map called `in` (empty: in any).
struct Alternative {
  std::string_view in;
  std::vector<std::string_view> left, right;
};
const std::vector<Alternative>& alternatives();

/// The names of the forms that a shape may have.
const std::vector<std::string>& shape_forms();

/// The keys of a container that are not those of its hollow.
const std::vector<std::string>& container_keys();

/// Returns the map as YAML text; small maps and all lists on one line.
std::string write_yaml(const YamlNode& map);

}  // namespace dreampm::scene
