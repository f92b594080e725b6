// Reading single values strictly, with messages that say what would be right; and writing them so
// that they read back.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "dreampm/math/vec.h"
#include "dreampm/scene/tree.h"

namespace dreampm::scene {

/// The numbers allowed; ends belong to it unless they are open.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open_min = false, open_max = false;
  const char* unit = "";

  bool contains(double v) const { return (open_min ? v > min : v >= min) && (open_max ? v < max : v <= max); }
  /// "above 0 m", "between 1 and 150 degrees", "at least 0"
  std::string text() const;
};
inline Range above_zero(const char* unit = "") {
  return {0, std::numeric_limits<double>::infinity(), true, false, unit};
}
inline Range at_least_zero(const char* unit = "") {
  return {0, std::numeric_limits<double>::infinity(), false, false, unit};
}
/// Any number; the unit is for the reference page.
inline Range any_number(const char* unit = "") {
  Range range;
  range.unit = unit;
  return range;
}
inline Range between(double min, double max, const char* unit = "") { return {min, max, false, false, unit}; }

/// Each reads one value; `path` names it in messages. Nothing if it was wrong, which has then been
/// reported.
std::optional<double> read_number(Problems& problems, const YamlNode& node, const std::string& path, const Range& range,
                                  const char* what = "a number");
std::optional<std::int64_t> read_count(Problems& problems, const YamlNode& node, const std::string& path,
                                       std::int64_t min, std::int64_t max);
std::optional<bool> read_flag(Problems& problems, const YamlNode& node, const std::string& path);
std::optional<std::string> read_text(Problems& problems, const YamlNode& node, const std::string& path);
/// A list of three numbers, each in the range; `parts` says which.
std::optional<Vec3d> read_vector(Problems& problems, const YamlNode& node, const std::string& path, const Range& range,
                                 const char* parts = "[x, y, z]");
/// The word itself if it is one of `words`.
std::optional<std::string> read_word(Problems& problems, const YamlNode& node, const std::string& path,
                                     std::span<const std::string> words);
/// Is the node a map? Otherwise reports that it must be one.
bool expect_map(Problems& problems, const YamlNode& node, const std::string& path);
bool expect_list(Problems& problems, const YamlNode& node, const std::string& path);

YamlNode write_number(double v);
YamlNode write_count(std::int64_t v);
YamlNode write_flag(bool v);
YamlNode write_text(std::string v);
YamlNode write_vector(const Vec3d& v);

}  // namespace dreampm::scene
