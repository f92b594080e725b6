#include "dreampm/scene/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace dreampm::scene {
namespace {

struct Unit {
  std::string_view name;
  double factor;  ///< to the SI unit, or to degrees
};
constexpr Unit units[] = {
    {"nm", 1e-9},   {"um", 1e-6},   {"mm", 1e-3},      {"cm", 1e-2},   {"dm", 0.1},     {"m", 1},        {"km", 1e3},
    {"in", 0.0254}, {"ft", 0.3048}, {"us", 1e-6},      {"ms", 1e-3},   {"s", 1},        {"sec", 1},      {"min", 60},
    {"h", 3600},    {"g", 1e-3},    {"kg", 1},         {"t", 1e3},     {"Pa", 1},       {"hPa", 100},    {"kPa", 1e3},
    {"MPa", 1e6},   {"GPa", 1e9},   {"bar", 1e5},      {"Pa s", 1},    {"Pa*s", 1},     {"mPa s", 1e-3}, {"mPas", 1e-3},
    {"cP", 1e-3},   {"kg/m3", 1},   {"kg/m^3", 1},     {"g/cm3", 1e3}, {"g/cm^3", 1e3}, {"g/ml", 1e3},   {"m/s", 1},
    {"cm/s", 1e-2}, {"mm/s", 1e-3}, {"km/h", 1 / 3.6}, {"m/s2", 1},    {"m/s^2", 1},    {"%", 0.01},     {"deg", 1},
    {"degrees", 1}, {"fps", 1},     {"Hz", 1},         {"px", 1},      {"1/m", 1},      {"rad/s", 1},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The number at the start of `s` and how many characters it takes; none if there is no number.
std::size_t leading_number(std::string_view s, double& v) {
  const std::size_t sign = !s.empty() && (s[0] == '+' || s[0] == '-') ? 1 : 0;
  if (sign == s.size() || !(is_digit(s[sign]) || (s[sign] == '.' && sign + 1 < s.size() && is_digit(s[sign + 1]))))
    return 0;
  const char* first = s.data() + (s[0] == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(first, s.data() + s.size(), v);
  if (error == std::errc::result_out_of_range) v = std::numeric_limits<double>::infinity();
  return std::size_t(end - s.data());
}

bool all(std::string_view s, std::string_view of) { return s.find_first_not_of(of) == s.npos; }

/// Why a text is no number; empty if nothing special can be said.
std::string reason(const std::string& s) {
  std::string low = s;
  std::transform(low.begin(), low.end(), low.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  std::string_view word = low;
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
  if (!word.empty() && word[0] == '.') word.remove_prefix(1);
  if (word == "nan" || word == "inf" || word == "infinity") return "must be a finite number";
  const std::string_view bare =
      !low.empty() && (low[0] == '+' || low[0] == '-') ? std::string_view(low).substr(1) : std::string_view(low);
  if (bare.size() > 2 && bare[0] == '0' && (bare[1] == 'x' || bare[1] == 'o' || bare[1] == 'b'))
    return "must be a decimal number, not hexadecimal, octal or binary";
  double v = 0;
  const std::size_t used = leading_number(s, v);
  if (used == 0) return {};
  if (std::isinf(v)) return "is too large or too small for a number";
  std::string_view rest = std::string_view(s).substr(used);
  if (rest[0] == ',' && rest.size() > 1 && is_digit(rest[1])) {
    std::string with_point = s;
    with_point[used] = '.';
    double fraction = 0;
    if (leading_number(with_point, fraction) == s.size())
      return fmt::format("must have a decimal point, not a comma: write {}", with_point);
  }
  if (all(s, "+-0123456789_.") && s.find('_') != s.npos) {
    std::string without = s;
    std::erase(without, '_');
    return fmt::format("must have no underscores: write {}", without);
  }
  while (!rest.empty() && rest[0] == ' ') rest.remove_prefix(1);
  for (const Unit& u : units)
    if (rest == u.name) return fmt::format("must be a number without a unit, in SI: write {:.12g}", v * u.factor);
  return {};
}

std::optional<double> plain_number(Problems& problems, const YamlNode& node, const std::string& path,
                                   const char* what) {
  const auto bad = [&](std::string_view why) {
    problems.error(node.at, fmt::format("{} is {}: {}", path, node.describe(), why));
    return std::nullopt;
  };
  const std::string general = fmt::format("must be {}", what);
  if (node.kind != YamlNode::Kind::scalar) return bad(general);
  double v = 0;
  const std::size_t used = leading_number(node.text, v);
  if (used == 0 || used != node.text.size() || !std::isfinite(v)) {
    const std::string why = reason(node.text);
    return bad(why.empty() ? general : why);
  }
  if (node.quoted) return bad(fmt::format("must be {}, without quotes", what));
  const std::size_t start = node.text[0] == '-' || node.text[0] == '+' ? 1 : 0;
  if (node.text.size() > start + 1 && node.text[start] == '0' && is_digit(node.text[start + 1])) {
    const std::size_t first = std::min(node.text.find_first_not_of('0', start), node.text.size() - 1);
    const bool cut = !is_digit(node.text[first]) && first > start;
    return bad(fmt::format("must not start with 0, which may mean an octal number: write {}{}",
                           node.text[0] == '-' ? "-" : "", node.text.substr(cut ? first - 1 : first)));
  }
  return v;
}

}  // namespace

std::string Range::text() const {
  const std::string u = *unit ? fmt::format(" {}", unit) : std::string();
  const bool low = std::isfinite(min), high = std::isfinite(max);
  if (low && high && !open_min && !open_max) return fmt::format("between {:.6g} and {:.6g}{}", min, max, u);
  std::string t;
  if (low) t = fmt::format("{} {:.6g}", open_min ? "above" : "at least", min);
  if (high) t += fmt::format("{}{} {:.6g}", low ? " and " : "", open_max ? "below" : "at most", max);
  return t + u;
}

std::optional<double> read_number(Problems& problems, const YamlNode& node, const std::string& path, const Range& range,
                                  const char* what) {
  const auto v = plain_number(problems, node, path, what);
  if (v && !range.contains(*v)) {
    problems.error(node.at, fmt::format("{} is {}: must be {}", path, node.text, range.text()));
    return std::nullopt;
  }
  return v;
}

std::optional<std::int64_t> read_count(Problems& problems, const YamlNode& node, const std::string& path,
                                       std::int64_t min, std::int64_t max) {
  const auto v = plain_number(problems, node, path, "a whole number");
  if (!v) return std::nullopt;
  if (*v != std::floor(*v)) {
    problems.error(node.at, fmt::format("{} is {}: must be a whole number", path, node.text));
    return std::nullopt;
  }
  // Digits are read as an integer, so that no seed is rounded; 1e6 goes through double.
  std::int64_t n = 0;
  const char* last = node.text.data() + node.text.size();
  const char* first = node.text.data() + (node.text[0] == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(first, last, n);
  bool fits = error == std::errc() && end == last;
  if (!fits && std::abs(*v) < 0x1p53) n = std::int64_t(*v), fits = true;
  if (!fits || n < min || n > max) {
    const std::string limits = max == std::numeric_limits<std::int64_t>::max()
                                   ? fmt::format("at least {}", min)
                                   : fmt::format("between {} and {}", min, max);
    problems.error(node.at, fmt::format("{} is {}: must be a whole number {}", path, node.text, limits));
    return std::nullopt;
  }
  return n;
}

std::optional<bool> read_flag(Problems& problems, const YamlNode& node, const std::string& path) {
  if (node.kind == YamlNode::Kind::scalar && !node.quoted && (node.text == "true" || node.text == "false"))
    return node.text == "true";
  problems.error(node.at, fmt::format("{} is {}: must be true or false", path, node.describe()));
  return std::nullopt;
}

std::optional<std::string> read_text(Problems& problems, const YamlNode& node, const std::string& path) {
  if (node.kind == YamlNode::Kind::scalar && !node.text.empty()) return node.text;
  problems.error(node.at, fmt::format("{} is {}: must be a text", path, node.describe()));
  return std::nullopt;
}

std::optional<Vec3d> read_vector(Problems& problems, const YamlNode& node, const std::string& path, const Range& range,
                                 const char* parts) {
  if (node.kind != YamlNode::Kind::list || node.items.size() != 3) {
    const std::string is =
        node.kind == YamlNode::Kind::list ? fmt::format("a list of {}", node.items.size()) : node.describe();
    problems.error(node.at, fmt::format("{} is {}: must be a list of 3 numbers, {}", path, is, parts));
    return std::nullopt;
  }
  Vec3d v;
  bool good = true;
  for (int i = 0; i < 3; ++i) {
    const auto n = read_number(problems, node.items[std::size_t(i)], fmt::format("{}[{}]", path, i), range);
    if (n) v[i] = *n;
    good = good && n;
  }
  return good ? std::optional(v) : std::nullopt;
}

std::optional<std::string> read_word(Problems& problems, const YamlNode& node, const std::string& path,
                                     std::span<const std::string> words) {
  if (node.kind == YamlNode::Kind::scalar && std::find(words.begin(), words.end(), node.text) != words.end())
    return node.text;
  const std::string hint = suggest(node.kind == YamlNode::Kind::scalar ? node.text : "", words);
  problems.error(node.at, fmt::format("{} is {}{}", path, node.describe(), hint));
  return std::nullopt;
}

bool expect_map(Problems& problems, const YamlNode& node, const std::string& path) {
  if (!node.is_map()) problems.error(node.at, fmt::format("{} is {}: must be a map of keys", path, node.describe()));
  return node.is_map();
}

bool expect_list(Problems& problems, const YamlNode& node, const std::string& path) {
  const bool is = node.kind == YamlNode::Kind::list;
  if (!is) problems.error(node.at, fmt::format("{} is {}: must be a list", path, node.describe()));
  return is;
}

YamlNode write_number(double v) { return YamlNode::scalar(fmt::format("{}", v == 0 ? 0.0 : v)); }
YamlNode write_count(std::int64_t v) { return YamlNode::scalar(fmt::format("{}", v)); }
YamlNode write_flag(bool v) { return YamlNode::scalar(v ? "true" : "false"); }
YamlNode write_text(std::string v) { return YamlNode::scalar(std::move(v), true); }
YamlNode write_vector(const Vec3d& v) {
  return YamlNode::list({write_number(v.x), write_number(v.y), write_number(v.z)});
}

}  // namespace dreampm::scene
