#include <charconv>
#include <limits>
#include <set>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/gzip.h"
#include "dreampm/import/ply_values.h"
#include "dreampm/io/byte_sink.h"
#include "dreampm/io/ply.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr const char* color_names[4] = {"red", "green", "blue", "alpha"};
const std::set<std::string, std::less<>> own_names = {"x",  "y",        "z",   "vx",    "vy",   "vz",
                                                      "id", "material", "red", "green", "blue", "alpha"};

void check_frame(const std::string& file, const ParticleFrame& frame) {
  const std::size_t n = frame.size();
  const auto same = [&](const char* name, std::size_t size, bool optional) {
    if (size != n && !(optional && size == 0))
      fail_input("{}: cannot be written: {} positions but {} values of {}", file, n, size, name);
  };
  same("velocity", frame.velocity.size(), false);
  same("id", frame.id.size(), false);
  same("material", frame.material.size(), false);
  same("color", frame.color.size(), true);
  same("exact", frame.exact.size(), true);
  for (const auto& [name, values] : frame.columns) {
    same(name.c_str(), values.size(), true);
    if (name.empty() || name.find_first_of(" \t\r\n") != std::string::npos || own_names.count(name))
      fail_input("{}: cannot be written: \"{}\" cannot name a column", file, name);
  }
  for (const auto& [names, what] : {std::pair{&frame.material_names, "material"}, {&frame.source_names, "source"}})
    for (const std::string& name : *names)
      if (name.empty() || name.find_first_of("\r\n") != std::string::npos)
        fail_input("{}: cannot be written: \"{}\" cannot name a {}", file, name, what);
  for (std::size_t i = 0; i < n; ++i)
    if (frame.material[i] >= frame.material_names.size())
      fail_input("{}: cannot be written: particle {} is of material {}, but {} materials have names", file, i,
                 frame.material[i], frame.material_names.size());
}

// "material 0 water", "source 0 tap": `what` is the first word.
void take_name(const PlyValues& body, const std::string& comment, std::string_view what,
               std::vector<std::string>& names) {
  const std::string key = fmt::format("{} ", what);
  if (comment.rfind(key, 0) != 0) return;
  const unsigned most = what == "material" ? 255 : 65535;
  const char* const end = comment.data() + comment.size();
  unsigned index = 0;
  const auto [stop, error] = std::from_chars(comment.data() + key.size(), end, index);
  if (error != std::errc() || stop == end || *stop != ' ' || index > most)
    fail_input("{}: \"comment {}\" does not read \"comment {} NUMBER NAME\" with a number of 0 to {}", body.file(),
               comment, what, most);
  if (names.size() <= index) names.resize(index + 1);
  names[index] = std::string(stop + 1, end);
}

template <class T>
T need_whole(const PlyValues& body, const char* name, double value, std::size_t row) {
  const std::optional<T> n = whole<T>(value);
  if (!n)
    fail_input("{}: {} of particle {} is {}: a whole number of {} to {} is wanted", body.file(), name, row, value,
               std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
  return *n;
}

}  // namespace

void write_particles(const fs::path& file, const ParticleFrame& frame, const std::string& note) {
  check_frame(file.string(), frame);
  std::vector<const float*> extra;
  std::string head = fmt::format("ply\nformat binary_little_endian 1.0\ncomment dreampm particles, {}\n", note);
  for (std::size_t i = 0; i < frame.material_names.size(); ++i)
    head += fmt::format("comment material {} {}\n", i, frame.material_names[i]);
  for (std::size_t i = 0; i < frame.source_names.size(); ++i)
    head += fmt::format("comment source {} {}\n", i, frame.source_names[i]);
  head += ply_shift_comment(frame.shift);
  head += fmt::format("element vertex {}\n", frame.size());
  const bool exact = !frame.exact.empty();
  for (const char* name : {"x", "y", "z"}) head += fmt::format("property {} {}\n", exact ? "double" : "float", name);
  for (const char* name : {"vx", "vy", "vz"}) head += fmt::format("property float {}\n", name);
  head += "property int id\nproperty uchar material\n";
  for (const auto& [name, values] : frame.columns)
    if (!values.empty()) {
      head += fmt::format("property float {}\n", name);
      extra.push_back(values.data());
    }
  if (!frame.color.empty())
    for (const char* name : color_names) head += fmt::format("property uchar {}\n", name);
  head += "end_header\n";

  replace_file(file, [&](const fs::path& temporary) {
    ByteSink out(temporary, file);
    out.text(head);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      if (exact)
        out.value(frame.exact[i]);
      else
        out.value(frame.position[i]);
      out.value(frame.velocity[i]);
      out.value(frame.id[i]);
      out.value(frame.material[i]);
      for (const float* column : extra) out.value(column[i]);
      if (!frame.color.empty()) out.value(frame.color[i]);
    }
    out.close();
  });
}

ParticleFrame read_particles(const fs::path& file) {
  const std::string text = read_unpacked(file);
  PlyValues body(text, file.string());
  const PlyHeader& header = body.header();
  if (header.elements.empty() || header.elements.front().name != "vertex")
    fail_input("{}: no particles: the first element must be \"vertex\"", body.file());
  const PlyElement& vertex = header.elements.front();
  if (vertex.has_list()) fail_input("{}: element vertex has a list: particles have plain values only", body.file());
  const auto position = ply_triple(vertex, "x", "y", "z");
  if (!position) fail_input("{}: element vertex lacks x, y or z", body.file());
  const auto velocity = ply_triple(vertex, "vx", "vy", "vz");
  const auto id = ply_index(vertex, "id"), material = ply_index(vertex, "material");

  ParticleFrame frame;
  for (const std::string& comment : header.comments) {
    take_name(body, comment, "material", frame.material_names);
    take_name(body, comment, "source", frame.source_names);
  }
  frame.shift = ply_shift(header, body.file());
  const auto n = static_cast<std::size_t>(vertex.count);
  frame.position.resize(n);
  frame.velocity.resize(n);
  frame.id.resize(n);
  frame.material.resize(n);
  std::vector<std::pair<std::size_t, float*>> columns;
  for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
    const std::string& name = vertex.properties[p].name;
    if (own_names.count(name)) continue;
    std::vector<float>& column = frame.columns[name];
    column.resize(n);
    columns.emplace_back(p, column.data());
  }
  std::array<std::optional<std::size_t>, 4> color;
  for (std::size_t c = 0; c < 4; ++c) color[c] = ply_index(vertex, color_names[c]);
  const bool colored = color[0] && color[1] && color[2];
  if (colored) frame.color.resize(n, {0, 0, 0, 255});

  body.rows(vertex, [&](std::size_t i, const std::vector<double>& values) {
    frame.position[i] = ply_vec(values, *position);
    if (!is_finite(frame.position[i]))
      fail_input("{}: the position of particle {} is not finite: ({}, {}, {})", body.file(), i, frame.position[i].x,
                 frame.position[i].y, frame.position[i].z);
    if (velocity) frame.velocity[i] = ply_vec(values, *velocity);
    frame.id[i] = id ? need_whole<std::int32_t>(body, "id", values[*id], i) : static_cast<std::int32_t>(i);
    frame.material[i] = material ? need_whole<std::uint8_t>(body, "material", values[*material], i) : std::uint8_t(0);
    for (const auto& [p, column] : columns) column[i] = static_cast<float>(values[p]);
    if (colored)
      for (std::size_t c = 0; c < 4; ++c)
        if (color[c]) frame.color[i][c] = need_whole<std::uint8_t>(body, color_names[c], values[*color[c]], i);
  });
  if (header.elements.size() == 1) body.expect_end();
  return frame;
}

}  // namespace dreampm
