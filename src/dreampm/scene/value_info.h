// The values that keys of a scene take, as data. The tables of the sections (fields.h) make it, and
// `dreampm schema` prints it: as a page, and as a JSON Schema.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "dreampm/scene/value.h"

namespace dreampm::scene {

struct MapInfo;
struct ValueInfo;

struct NumberInfo {
  Range range;
};
struct WholeInfo {
  std::int64_t min, max;
};
struct FlagInfo {};
struct TextInfo {
  std::string what;          ///< "a file", "the name of a material"
  std::string pattern = {};  ///< a regular expression for all of it; empty: any text
};
struct WordInfo {
  std::vector<std::string> words;
};
struct ListInfo {
  std::vector<ValueInfo> item;  ///< one: what each item is
  std::size_t min, max;         ///< how many items
};
/// A map of keys.
struct MapOf {
  std::string name;  ///< of one that stands in several places ("shape"); empty: called by its path
  std::function<MapInfo()> make;
};
/// A map whose keys are names that the scene gives.
struct NamesInfo {
  std::vector<ValueInfo> each;  ///< one
};
struct EitherInfo {
  std::vector<ValueInfo> of;
};
/// Some keys of a map, which are laid over it.
struct OverlayInfo {
  std::string what;
  std::function<MapInfo()> of;
};

struct ValueInfo {
  std::variant<std::monostate, NumberInfo, WholeInfo, FlagInfo, TextInfo, WordInfo, ListInfo, MapOf, NamesInfo,
               EitherInfo, OverlayInfo>
      form;
};

struct KeyInfo {
  std::string key;
  ValueInfo value;
  std::string meaning;                      ///< one sentence
  std::optional<YamlNode> by_default = {};  ///< none: required, or the meaning says what holds without it
  bool required = false;
  std::string unless = {};  ///< what makes a required key needless, in words
  std::string only = {};    ///< when the key applies, in words; empty: always
};

struct MapInfo {
  std::vector<KeyInfo> keys;
  /// Groups of keys of which exactly one group is given, and all of that one.
  std::vector<std::vector<std::string>> one_of = {};
  std::vector<std::string> at_least_one = {};  ///< of these keys
  std::vector<std::string> together = {};      ///< all of these keys or none
  /// The types that such a map may have, each with keys of its own beside `keys`.
  struct Type {
    std::string name, about;
    std::vector<KeyInfo> keys;
  };
  std::vector<Type> types = {};

  const KeyInfo* find(std::string_view key) const {
    for (const KeyInfo& k : keys)
      if (k.key == key) return &k;
    return nullptr;
  }
};

inline ValueInfo number_info(const Range& range) { return {NumberInfo{range}}; }
inline ValueInfo text_info(std::string what, std::string pattern = {}) {
  return {TextInfo{std::move(what), std::move(pattern)}};
}
inline ValueInfo word_info(std::vector<std::string> words) { return {WordInfo{std::move(words)}}; }
inline constexpr std::size_t any_length = std::numeric_limits<std::size_t>::max();
inline ValueInfo list_info(ValueInfo item, std::size_t min, std::size_t max = any_length) {
  return {ListInfo{{std::move(item)}, min, max}};
}
inline ValueInfo vector_info(const Range& range) { return list_info(number_info(range), 3, 3); }
inline ValueInfo names_info(ValueInfo each) { return {NamesInfo{{std::move(each)}}}; }
inline ValueInfo either(std::vector<ValueInfo> of) { return {EitherInfo{std::move(of)}}; }
/// `name`: empty, or that of a map which stands in several places.
inline ValueInfo map_of(std::function<MapInfo()> make, std::string name = {}) {
  return {MapOf{std::move(name), std::move(make)}};
}

/// The whole scene.
MapInfo scene_info();

/// A help text as a sentence: with a capital and a full stop.
std::string sentence(std::string_view help);

/// The pattern of names in a scene, a regular expression.
inline constexpr const char* good_name_pattern = "^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$";

}  // namespace dreampm::scene
