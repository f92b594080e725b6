#include "dreampm/pipeline/changes.h"

#include <fmt/format.h>

#include <map>
#include <sstream>

namespace dreampm {
namespace {

using Keys = std::map<std::string, std::string>;

/// Splits the inside of {a: 1, b: [2, 3]} at its own commas.
std::vector<std::string> entries_of(const std::string& inside) {
  std::vector<std::string> list;
  std::string entry;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const char c = inside[i];
    if (c == '"' && (i == 0 || inside[i - 1] != '\\')) quoted = !quoted;
    if (!quoted && (c == '{' || c == '[')) ++depth;
    if (!quoted && (c == '}' || c == ']')) --depth;
    if (!quoted && depth == 0 && c == ',') {
      list.push_back(entry);
      entry.clear();
      ++i;  // the space behind it
    } else {
      entry += c;
    }
  }
  if (!entry.empty()) list.push_back(entry);
  return list;
}

void add_entry(const std::string& path, const std::string& entry, Keys& keys) {
  const std::size_t colon = entry.find(": ");
  const std::string key = path + entry.substr(0, colon),
                    value = colon == std::string::npos ? "" : entry.substr(colon + 2);
  if (value.size() > 2 && value.front() == '{') {
    for (const std::string& e : entries_of(value.substr(1, value.size() - 2))) add_entry(key + ".", e, keys);
  } else {
    keys[key] = value;
  }
}

/// Every key with its full path. Indents are two spaces a level.
Keys flatten(const std::string& yaml) {
  Keys keys;
  std::vector<std::string> path;
  std::istringstream in(yaml);
  for (std::string line; std::getline(in, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos) continue;
    path.resize(std::min(path.size(), indent / 2));
    std::string prefix;
    for (const std::string& p : path) prefix += p + ".";
    if (line.back() == ':')
      path.push_back(line.substr(indent, line.size() - indent - 1));
    else
      add_entry(prefix, line.substr(indent), keys);
  }
  return keys;
}

}  // namespace

std::vector<std::string> changed_keys(const std::string& before, const std::string& after) {
  const Keys a = flatten(before), b = flatten(after);
  std::vector<std::string> list;
  for (const auto& [key, value] : a) {
    const auto now = b.find(key);
    if (now == b.end())
      list.push_back(fmt::format("{}: {} -> none", key, value));
    else if (now->second != value)
      list.push_back(fmt::format("{}: {} -> {}", key, value, now->second));
  }
  for (const auto& [key, value] : b)
    if (!a.contains(key)) list.push_back(fmt::format("{}: none -> {}", key, value));
  return list;
}

}  // namespace dreampm
