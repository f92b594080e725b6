#include "dreampm/farm/wedge.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/base/hash.h"

namespace dreampm::farm {
namespace {

constexpr std::size_t most_runs = 10000;
constexpr std::size_t longest_name = 120;  // a file's name has at most 255 bytes

std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values{""};
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      values.emplace_back();
      continue;
    }
    values.back() += c;
  }
  return values;
}

/// The end of a path by which no two keys are the same.
std::vector<std::string> short_names(const std::vector<WedgeKey>& keys) {
  std::vector<std::string> names;
  for (const WedgeKey& key : keys) {
    const std::string last = key.path.substr(key.path.rfind('.') + 1);
    const auto alike = std::count_if(keys.begin(), keys.end(), [&](const WedgeKey& other) {
      return other.path.substr(other.path.rfind('.') + 1) == last;
    });
    names.push_back(alike > 1 ? key.path : last);
  }
  return names;
}

/// Letters, digits and a few signs as they are; where others stood, or too many, the hash says
/// which.
std::string file_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    name += u < 0x80 && (std::isalnum(u) || std::string_view("=,._+-").find(c) != std::string_view::npos) ? c : '_';
  }
  if (name == text && name.size() <= longest_name) return name;
  Hash64 hash;
  hash.add(std::string_view(text));
  return name.substr(0, longest_name) + "-" + hash.hex().substr(0, 8);
}

}  // namespace

WedgeKey wedge_key(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == argument.size())
    fail_input("'{}' must read KEY=a,b,c, as in space.spacing=0.01,0.02", argument);
  WedgeKey key{argument.substr(0, equals), split_values(argument.substr(equals + 1))};
  std::set<std::string> known;
  for (const std::string& v : key.values) {
    if (v.empty()) fail_input("'{}' has an empty value", argument);
    if (!known.insert(v).second) fail_input("'{}' has the value {} twice", argument, v);
  }
  return key;
}

std::vector<std::string> WedgeRun::settings(const std::vector<std::string>& keys) const {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < keys.size(); ++k) all.push_back(keys[k] + "=" + values.at(k));
  return all;
}

Wedge wedge_of(const std::vector<WedgeKey>& keys) {
  Wedge wedge;
  std::size_t count = 1;
  for (const WedgeKey& key : keys) {
    if (std::find(wedge.keys.begin(), wedge.keys.end(), key.path) != wedge.keys.end())
      fail_input("{} is given twice; name all its values at once", key.path);
    wedge.keys.push_back(key.path);
    count *= key.values.size();
    if (count > most_runs) fail_input("more than {} runs: fewer values make fewer", most_runs);
  }
  const std::vector<std::string> names = short_names(keys);
  for (std::size_t r = 0; r < count; ++r) {
    WedgeRun run;
    std::size_t rest = r, block = count;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      block /= keys[k].values.size();
      run.values.push_back(keys[k].values[rest / block]);
      rest %= block;
      run.name += (k > 0 ? "," : "") + names[k] + "=" + run.values.back();
    }
    run.name = file_name(run.name);
    wedge.runs.push_back(std::move(run));
  }
  return wedge;
}

std::filesystem::path table_file(const std::filesystem::path& folder) { return folder / "wedge.csv"; }

}  // namespace dreampm::farm
