#include "dreampm/import/ply.h"

#include <cmath>
#include <limits>

#include "dreampm/base/error.h"
#include "dreampm/geometry/whole.h"
#include "dreampm/import/ply_values.h"

namespace dreampm {
namespace {

bool is_whole(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

void read_vertices(PlyValues& in, const PlyElement& vertex, Model& model) {
  const auto place = ply_triple(vertex, "x", "y", "z");
  if (!place) fail_input("{}: its vertices lack x, y or z", in.file());
  if (vertex.count > std::numeric_limits<std::uint32_t>::max())
    fail_input("{}: {} vertices are more than can be counted here", in.file(), vertex.count);
  const auto velocity = ply_triple(vertex, "vx", "vy", "vz"), color = ply_triple(vertex, "red", "green", "blue");
  const auto id = ply_index(vertex, "id"), alpha = ply_index(vertex, "alpha");
  const bool bytes = color && is_whole(vertex.properties[(*color)[0]].type);
  model.vertices.resize(static_cast<std::size_t>(vertex.count));
  if (velocity) model.velocities.resize(model.vertices.size());
  if (id) model.ids.resize(model.vertices.size());
  if (color) model.colors.resize(model.vertices.size());
  in.rows(vertex, [&](std::size_t v, const std::vector<double>& values) {
    model.vertices[v] = ply_point(values, *place);
    if (velocity) model.velocities[v] = ply_point(values, *velocity);
    if (velocity && !is_finite(model.velocities[v]))
      fail_input("{}: the velocity of vertex {} is not finite", in.file(), v);
    if (id) {
      const std::optional<std::int64_t> n = whole<std::int64_t>(values[*id]);
      if (!n) fail_input("{}: the id of vertex {} is {}: a whole number is wanted", in.file(), v, values[*id]);
      model.ids[v] = *n;
    }
    if (color) {
      const auto part = [&](std::size_t at) { return color_byte(values[at] * (bytes ? 1 : 255)); };
      model.colors[v] = {part((*color)[0]), part((*color)[1]), part((*color)[2]),
                         alpha ? part(*alpha) : std::uint8_t(255)};
    }
  });
}

void read_faces(PlyValues& in, const PlyElement& element, bool strips, Model& model) {
  const PlyProperty* const corners = element.corners();
  if (!corners && element.count > 0)
    fail_input("{}: its element {} lacks the list vertex_indices", in.file(), element.name);
  const auto vertices = static_cast<double>(model.vertices.size());
  std::vector<std::uint32_t> named;
  const auto end = [&] {
    if (strips)
      add_strip(model, named);
    else
      add_polygon(model, named);
    named.clear();
  };
  for (std::uint64_t row = 0; row < element.count; ++row)
    for (const PlyProperty& p : element.properties) {
      if (&p != corners) {
        in.skip(p, element, row);
        continue;
      }
      for (std::uint64_t n = in.list_length(p, element, row); n > 0; --n) {
        const double index = in.next(p.type, element, row);
        if (strips && index == -1) {
          end();
          continue;
        }
        if (!(index >= 0) || index >= vertices || index != std::floor(index))
          fail_input("{}: {} {} names vertex {}, but there are {} (0 to {})", in.file(),
                     strips ? "strip" : element.name, row, index, model.vertices.size(), vertices - 1);
        named.push_back(static_cast<std::uint32_t>(index));
      }
      end();
    }
}

}  // namespace

Model parse_ply(std::string_view text, const std::string& name) {
  PlyValues in(text, name);
  Model model;
  bool vertices = false;
  for (const PlyElement& e : in.header().elements) {
    const bool strips = e.name == "tristrips";
    if (e.name == "vertex") {
      vertices = true;
      read_vertices(in, e, model);
    } else if (e.name == "face" || strips) {
      if (!vertices && e.count > 0) fail_input("{}: its {}s come before its vertices", name, strips ? "strip" : "face");
      read_faces(in, e, strips, model);
    } else if (e.corners() && e.count > 0) {
      fail_input("{}: its element \"{}\" joins vertices in a way that is not read; \"face\" and \"tristrips\" are",
                 name, printable(e.name));
    } else {
      for (std::uint64_t row = 0; row < e.count; ++row) in.skip_row(e, row);
    }
  }
  require_finite(model, name);
  if (!vertices) fail_input("{}: has no element \"vertex\"", name);
  if (const std::size_t bytes = in.left(); bytes > 0)
    model.warnings.push_back(fmt::format("{}: {} bytes follow its last element; passed over", name, bytes));
  return model;
}

}  // namespace dreampm
