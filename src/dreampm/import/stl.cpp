#include "dreampm/import/stl.h"

#include <cstring>

#include "dreampm/base/error.h"
#include "dreampm/import/text_lines.h"

namespace dreampm {
namespace {

constexpr std::size_t head = 84, record = 50;  // bytes: a comment and the count; a normal, three corners, two bytes

/// The words of a text, across lines.
class Words {
 public:
  Words(std::string_view text, const std::string& name) : lines_(text, name, '\0'), name_(name) {}

  /// The next word in lower case; empty at the end.
  std::string next() {
    if (at_ == lines_.words().size()) {
      at_ = 0;
      if (!lines_.next()) return {};
    }
    return lower(lines_.words()[at_++]);
  }
  void expect(const char* word) { expect(word, next()); }
  void expect(const std::string& word, const std::string& found) {
    if (found.empty() || (found != word && word.starts_with(found) && next().empty()))
      fail_input("{}: is cut short: it has no endsolid", name_);
    if (found != word) fail_input("{}:{}: \"{:.30}\" where \"{}\" must stand", name_, lines_.line(), found, word);
  }
  double number() {
    const std::string word = next();
    if (word.empty()) fail_input("{}: is cut short: it has no endsolid", name_);
    return lines_.number_in<double>(word, "a coordinate");
  }
  void skip_line() { at_ = lines_.words().size(); }
  int line() const { return lines_.line(); }

 private:
  TextLines lines_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// A text has "facet", or nothing, after the line of "solid"; binary files may start with that word
/// as well.
bool is_text(std::string_view text, const std::string& name) {
  TextLines lines(text.substr(0, 4096), name, '\0');
  if (!lines.next() || lower(lines.words()[0]) != "solid") return false;
  if (!lines.next()) return text.find('\0') == std::string_view::npos;
  const std::string second = lower(lines.words()[0]);
  return second == "facet" || second == "endsolid";
}

void read_facet(Words& in, Model& model) {
  in.expect("normal");
  for (int i = 0; i < 3; ++i) in.next();  // found from the corners; often 0 or not a number
  in.expect("outer"), in.expect("loop");
  std::vector<std::uint32_t> polygon;
  std::string word = in.next();
  for (; word == "vertex"; word = in.next()) {
    const double x = in.number(), y = in.number(), z = in.number();
    polygon.push_back(static_cast<std::uint32_t>(model.vertices.size()));
    model.vertices.push_back({x, y, z});
  }
  in.expect("endloop", word);
  in.expect("endfacet");
  add_polygon(model, polygon);
}

Model read_text(std::string_view text, const std::string& name) {
  Words in(text, name);
  Model model;
  for (std::string word = in.next(); !word.empty(); word = in.next()) {
    in.expect("solid", word);
    in.skip_line();  // its name
    for (word = in.next(); word == "facet"; word = in.next()) read_facet(in, model);
    if (word.empty()) fail_input("{}: is cut short: it has no endsolid", name);
    if (word != "endsolid")
      fail_input("{}:{}: \"{:.30}\" where \"facet\" or \"endsolid\" must stand", name, in.line(), word);
    in.skip_line();
  }
  return model;
}

Model read_binary(std::string_view bytes, const std::string& name, std::size_t count) {
  Model model;
  model.vertices.reserve(3 * count), model.triangles.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    float corners[9];
    std::memcpy(corners, bytes.data() + head + record * t + 12, sizeof corners);
    const auto first = static_cast<std::uint32_t>(model.vertices.size());
    for (int k = 0; k < 9; k += 3) model.vertices.push_back({corners[k], corners[k + 1], corners[k + 2]});
    model.triangles.push_back({first, first + 1, first + 2});
  }
  if (const std::size_t after = bytes.size() - head - record * count; after > 0)
    model.warnings.push_back(
        fmt::format("{}: {} bytes follow the {} triangles that it promises; passed over", name, after, count));
  return model;
}

}  // namespace

Model parse_stl(std::string_view text, const std::string& name) {
  std::uint32_t count = 0;
  if (text.size() >= head) std::memcpy(&count, text.data() + head - sizeof count, sizeof count);
  const std::uint64_t promised = head + record * std::uint64_t(count);
  Model model;
  if (text.size() >= head && promised == text.size()) {
    model = read_binary(text, name, count);
  } else if (is_text(text, name)) {
    model = read_text(text, name);
  } else if (text.size() < head) {
    fail_input("{}: is no STL file, or is cut short: {} bytes", name, text.size());
  } else if (promised > text.size() || count == 0) {
    fail_input("{}: promises {} triangles, which take {} bytes, but it has {}; it is cut short, or no STL file", name,
               count, promised, text.size());
  } else {
    model = read_binary(text, name, count);
  }
  require_finite(model, name);
  join_corners(model);
  return model;
}

}  // namespace dreampm
