#include "dreampm/geometry/off.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <vector>

#include "dreampm/base/error.h"

namespace dreampm {
namespace {

class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// Words of the next line that has any, comments left out.
  const std::vector<std::string_view>& next(const char* what) {
    do {
      if (at_ >= text_.size()) fail_input("{}: is cut short: it ends before {}", name_, what);
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      split(text_.substr(at_, end - at_));
      at_ = end + 1, ++line_;
    } while (words_.empty());
    return words_;
  }

  template <class T>
  T number(std::size_t i, const char* what) const {
    if (i >= words_.size())
      fail_input("{}:{}: the line is cut short: {} wants more than {} numbers", name_, line_, what, words_.size());
    std::string_view word = words_[i];
    if (word.starts_with('+')) word.remove_prefix(1);
    T value{};
    const auto [end, ec] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (ec != std::errc() || end != word.data() + word.size())
      fail_input("{}:{}: {} that is right is wanted, not \"{:.30}\"", name_, line_, what, word);
    return value;
  }
  int line() const { return line_; }

 private:
  void split(std::string_view line) {
    words_.clear();
    line = line.substr(0, line.find('#'));
    for (std::size_t i = 0; i < line.size();) {
      const std::size_t begin = std::min(line.find_first_not_of(" \t\r", i), line.size());
      const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
      if (end > begin) words_.push_back(line.substr(begin, end - begin));
      i = end;
    }
  }
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace

TriMesh parse_off(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  const auto& first = lines.next("its first line");
  if (!first[0].ends_with("OFF") || first[0].find_first_of("4n") != std::string_view::npos ||
      (first.size() > 1 && first[1] == "BINARY"))
    fail_input("{}: is not an OFF file in text form and three dimensions (it does not start with OFF)", name);
  std::size_t at = 1;  // the counts may follow on the same line
  if (first.size() == 1) lines.next("its counts"), at = 0;
  const auto vertices = lines.number<std::uint64_t>(at, "a count of vertices"),
             faces = lines.number<std::uint64_t>(at + 1, "a count of faces");
  for (const auto& [count, what] : {std::pair(vertices, "vertices"), std::pair(faces, "faces")})
    if (count > text.size() / 4)  // the least: a face of one vertex, "1 0\n"
      fail_input("{}: promises {} {}, more than its {} bytes can hold", name, count, what, text.size());
  TriMesh mesh;
  mesh.vertices.reserve(vertices);
  for (std::uint64_t v = 0; v < vertices; ++v) {
    lines.next("its last vertex");
    const char* what = "a coordinate";
    mesh.vertices.push_back({lines.number<float>(0, what), lines.number<float>(1, what), lines.number<float>(2, what)});
  }
  mesh.triangles.reserve(faces);
  std::vector<std::uint32_t> polygon;
  for (std::uint64_t f = 0; f < faces; ++f) {
    const std::size_t words = lines.next("its last face").size();
    const auto corners = lines.number<std::uint64_t>(0, "a count of corners");
    if (corners >= words)
      fail_input("{}:{}: face {} promises {} corners, but the line is cut short", name, lines.line(), f, corners);
    polygon.clear();
    for (std::uint64_t k = 1; k <= corners; ++k) {
      const auto index = lines.number<std::int64_t>(k, "the index of a vertex");
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices)
        fail_input("{}:{}: face {} names vertex {}, but there are {} (0 to {})", name, lines.line(), f, index, vertices,
                   std::int64_t(vertices) - 1);
      polygon.push_back(static_cast<std::uint32_t>(index));
    }
    for (std::size_t k = 2; k < polygon.size(); ++k) mesh.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }
  return mesh;
}

}  // namespace dreampm
