// The tree as YAML text.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "dreampm/scene/tree.h"

namespace dreampm::scene {
namespace {

constexpr std::size_t line_length = 110;

/// May stand without quotes and still be read as the same text?
bool plain(const std::string& s) {
  static const std::vector<std::string> words{"true", "false", "null", "yes", "no", "on", "off", "y", "n"};
  if (s.empty() || !std::isalpha(static_cast<unsigned char>(s[0])) || s.back() == ':') return false;
  if (std::find(words.begin(), words.end(), s) != words.end()) return false;
  return std::all_of(s.begin(), s.end(), [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/' || c == ':');
  });
}

std::string quote(const std::string& s) {
  std::string q = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\')
      q += std::string("\\") + c;
    else if (c == '\n')
      q += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      q += fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      q += c;
  }
  return q + "\"";
}

std::string flow(const YamlNode& n) {
  std::string t;
  switch (n.kind) {
    case YamlNode::Kind::null:
      return "~";
    case YamlNode::Kind::scalar:
      return n.quoted && !plain(n.text) ? quote(n.text) : n.text;
    case YamlNode::Kind::list:
      for (const YamlNode& i : n.items) t += (t.empty() ? "" : ", ") + flow(i);
      return "[" + t + "]";
    case YamlNode::Kind::map:
      break;
  }
  for (const Entry& e : n.entries) t += (t.empty() ? "" : ", ") + e.key + ": " + flow(e.value);
  return "{" + t + "}";
}

bool holds_map(const YamlNode& n) {
  return std::any_of(n.entries.begin(), n.entries.end(), [](const Entry& e) { return e.value.is_map(); });
}

void block(const YamlNode& map, std::size_t indent, std::string& out) {
  for (const Entry& e : map.entries) {
    const std::string head = std::string(indent, ' ') + e.key + ":", one_line = flow(e.value);
    const bool small = head.size() + 1 + one_line.size() <= line_length && !holds_map(e.value);
    if (!e.value.is_map() || e.value.entries.empty() || small) {
      out += head + " " + one_line + "\n";
    } else {
      out += head + "\n";
      block(e.value, indent + 2, out);
    }
  }
}

}  // namespace

std::string write_yaml(const YamlNode& map) {
  std::string out;
  block(map, 0, out);
  return out;
}

}  // namespace dreampm::scene
