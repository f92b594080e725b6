#include "dreampm/pipeline/foam_files.h"

#include <charconv>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/gzip.h"
#include "dreampm/import/ply_values.h"
#include "dreampm/io/byte_sink.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view next_key = "next id ";

std::uint32_t next_id_of(const PlyHeader& header, const std::string& file) {
  for (const std::string& comment : header.comments) {
    if (!comment.starts_with(next_key)) continue;
    std::uint32_t n = 0;
    const char* const end = comment.data() + comment.size();
    const auto [stop, error] = std::from_chars(comment.data() + next_key.size(), end, n);
    if (error != std::errc() || stop != end) fail_input("{}: \"comment {}\" names no whole number", file, comment);
    return n;
  }
  fail_input("{}: has no \"comment next id NUMBER\": not a file of dreampm foam", file);
}

}  // namespace

void write_foam(const fs::path& file, const FoamParticles& foam, const Vec3d& shift) {
  std::string head = fmt::format("ply\nformat binary_little_endian 1.0\ncomment dreampm foam, {}\n", si_note);
  for (std::size_t t = 0; t < foam_type_names.size(); ++t)
    head += fmt::format("comment type {} {}\n", t, foam_type_names[t]);
  head += fmt::format("comment {}{}\n", next_key, foam.next_id) + ply_shift_comment(shift);
  head += fmt::format("element vertex {}\n", foam.size());
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz"}) head += fmt::format("property float {}\n", name);
  head += "property int id\nproperty uchar type\n";
  for (const char* name : {"age", "life", "radius"}) head += fmt::format("property float {}\n", name);
  head += "end_header\n";
  replace_file(file, [&](const fs::path& temporary) {
    ByteSink out(temporary, file);
    out.text(head);
    for (std::size_t i = 0; i < foam.size(); ++i) {
      out.value(foam.position[i]), out.value(foam.velocity[i]), out.value(foam.id[i]), out.value(foam.type[i]);
      out.value(foam.age[i]), out.value(foam.life[i]), out.value(foam.radius[i]);
    }
    out.close();
  });
}

FoamFrame read_foam(const fs::path& path) {
  const std::string file = path.string();
  const std::string text = read_unpacked(path);
  PlyValues body(text, file);
  const PlyElement* vertex = body.header().elements.empty() ? nullptr : &body.header().elements.front();
  if (!vertex || vertex->name != "vertex" || vertex->has_list())
    fail_input("{}: no foam: the first element must be \"vertex\", of plain values", file);
  const auto x = ply_triple(*vertex, "x", "y", "z"), v = ply_triple(*vertex, "vx", "vy", "vz");
  if (!x || !v) fail_input("{}: element vertex lacks x, y, z, vx, vy or vz", file);
  const auto column = [&](const char* name) {
    const auto at = ply_index(*vertex, name);
    if (!at) fail_input("{}: element vertex lacks {}: not a file of dreampm foam", file, name);
    return *at;
  };
  const std::size_t id = column("id"), type = column("type"), age = column("age"), life = column("life"),
                    radius = column("radius");
  FoamFrame out;
  out.shift = ply_shift(body.header(), file);
  FoamParticles& foam = out.particles;
  foam.next_id = next_id_of(body.header(), file);
  body.rows(*vertex, [&](std::size_t i, const std::vector<double>& values) {
    foam.position.push_back(ply_vec(values, *x)), foam.velocity.push_back(ply_vec(values, *v));
    if (!is_finite(foam.position.back()) || !is_finite(foam.velocity.back()))
      fail_input("{}: place or velocity of particle {} is not finite", file, i);
    const auto number = whole<std::int32_t>(values[id]);
    const auto kind = whole<std::uint8_t>(values[type]);
    if (!number || *number < 0)
      fail_input("{}: id of particle {} is {}: a whole number, not negative", file, i, values[id]);
    if (!kind || *kind >= foam_type_names.size())
      fail_input("{}: type of particle {} is {}: 0 to {} are known", file, i, values[type], foam_type_names.size() - 1);
    foam.id.push_back(*number), foam.type.push_back(static_cast<FoamType>(*kind));
    foam.age.push_back(static_cast<float>(values[age])), foam.life.push_back(static_cast<float>(values[life]));
    foam.radius.push_back(static_cast<float>(values[radius]));
    if (!(foam.radius.back() >= 0) || !std::isfinite(foam.radius.back()))
      fail_input("{}: radius of particle {} is {}: must be 0 or more", file, i, values[radius]);
  });
  if (body.header().elements.size() == 1) body.expect_end();
  return out;
}

}  // namespace dreampm
