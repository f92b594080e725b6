#include "dreampm/import/off.h"

#include <cstdint>
#include <vector>

#include "dreampm/base/error.h"
#include "dreampm/import/text_lines.h"

namespace dreampm {

Model parse_off(std::string_view text, const std::string& name) {
  TextLines lines(text, name, '#');
  const auto& first = lines.need("its first line");
  if (!first[0].ends_with("OFF") || first[0].find_first_of("4n") != std::string_view::npos ||
      (first.size() > 1 && first[1] == "BINARY"))
    fail_input("{}: is not an OFF file in text form and three dimensions (it does not start with OFF)", name);
  std::size_t at = 1;  // the counts may follow on the same line
  if (first.size() == 1) lines.need("its counts"), at = 0;
  const auto vertices = lines.number<std::uint64_t>(at, "a count of vertices"),
             faces = lines.number<std::uint64_t>(at + 1, "a count of faces");
  for (const auto& [count, what] : {std::pair(vertices, "vertices"), std::pair(faces, "faces")})
    if (count > text.size() / 4)  // the least: a face of one vertex, "1 0\n"
      fail_input("{}: promises {} {}, more than its {} bytes can hold", name, count, what, text.size());
  Model mesh;
  mesh.vertices.reserve(vertices);
  for (std::uint64_t v = 0; v < vertices; ++v) {
    lines.need("its last vertex");
    const char* what = "a coordinate";
    mesh.vertices.push_back(
        {lines.number<double>(0, what), lines.number<double>(1, what), lines.number<double>(2, what)});
  }
  mesh.triangles.reserve(faces);
  std::vector<std::uint32_t> polygon;
  for (std::uint64_t f = 0; f < faces; ++f) {
    const std::size_t words = lines.need("its last face").size();
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
    add_polygon(mesh, polygon);
  }
  return mesh;
}

}  // namespace dreampm
