#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/import/gzip.h"
#include "dreampm/import/ply_values.h"
#include "dreampm/io/byte_sink.h"
#include "dreampm/io/ply.h"
#include "dreampm/io/ply_attributes.h"
#include "dreampm/math/srgb.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

void check_mesh(const std::string& file, const TriMesh& mesh, const VertexAttributes& attributes) {
  const std::size_t n = mesh.vertices.size();
  if (!mesh.normals.empty() && mesh.normals.size() != n)
    fail_input("{}: cannot be written: {} vertices but {} normals", file, n, mesh.normals.size());
  if (!mesh.velocities.empty() && mesh.velocities.size() != n)
    fail_input("{}: cannot be written: {} vertices but {} velocities", file, n, mesh.velocities.size());
  for (const VertexAttribute& a : attributes)
    if (a.values.size() != n * a.width())
      fail_input("{}: cannot be written: {} vertices but {} numbers of {}", file, n, a.values.size(), a.name);
  if (n > std::size_t(INT32_MAX)) fail_input("{}: cannot be written: {} vertices, more than an int counts", file, n);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= n) fail_input("{}: cannot be written: triangle {} names vertex {} of {}", file, t, v, n);
}

void read_vertices(PlyValues& body, const PlyElement& vertex, TriMesh& mesh, VertexAttributes* attributes) {
  if (vertex.has_list()) fail_input("{}: element vertex has a list: only plain values are read", body.file());
  const auto position = ply_triple(vertex, "x", "y", "z");
  if (!position) fail_input("{}: element vertex lacks x, y or z", body.file());
  const auto normal = ply_triple(vertex, "nx", "ny", "nz"), velocity = ply_triple(vertex, "vx", "vy", "vz");
  const auto n = static_cast<std::size_t>(vertex.count);
  mesh.vertices.resize(n);
  if (normal) mesh.normals.resize(n);
  if (velocity) mesh.velocities.resize(n);
  std::optional<PlyAttributeReader> others;
  if (attributes) {
    std::vector<std::size_t> taken;
    for (const auto& triple : {position, normal, velocity})
      if (triple)
        for (const std::size_t p : *triple) taken.push_back(p);
    others.emplace(vertex, taken);
  }
  body.rows(vertex, [&](std::size_t i, const std::vector<double>& values) {
    mesh.vertices[i] = ply_vec(values, *position);
    if (!is_finite(mesh.vertices[i]))
      fail_input("{}: vertex {} is not finite: ({}, {}, {})", body.file(), i, mesh.vertices[i].x, mesh.vertices[i].y,
                 mesh.vertices[i].z);
    if (normal) mesh.normals[i] = ply_vec(values, *normal);
    if (velocity) mesh.velocities[i] = ply_vec(values, *velocity);
    if (others) others->take(values);
  });
  if (others) *attributes = std::move(others->attributes);
}

std::uint32_t vertex_index(const PlyValues& body, double value, std::uint64_t face, std::uint64_t vertices) {
  if (!(value >= 0 && value < static_cast<double>(vertices)) || value != std::floor(value))
    fail_input("{}: face {} names vertex {}: 0 to {} exist", body.file(), face, value,
               static_cast<std::int64_t>(vertices) - 1);
  return static_cast<std::uint32_t>(value);
}

void read_faces(PlyValues& body, const PlyElement& face, std::uint64_t vertices, TriMesh& mesh) {
  const PlyProperty* const corners = face.corners();
  if (!corners) fail_input("{}: element face lacks the list vertex_indices", body.file());
  mesh.triangles.reserve(static_cast<std::size_t>(face.count));
  for (std::uint64_t row = 0; row < face.count; ++row)
    for (const PlyProperty& p : face.properties) {
      if (&p != corners) {
        body.skip(p, face, row);
        continue;
      }
      const std::uint64_t count = body.list_length(p, face, row);
      if (count != 3 && count != 4) fail_input("{}: face {} has {} corners: 3 or 4 are read", body.file(), row, count);
      std::array<std::uint32_t, 4> v{};
      for (std::size_t i = 0; i < count; ++i) v[i] = vertex_index(body, body.next(p.type, face, row), row, vertices);
      mesh.triangles.push_back({v[0], v[1], v[2]});
      if (count == 4) mesh.triangles.push_back({v[0], v[2], v[3]});
    }
}

}  // namespace

void write_mesh(const fs::path& file, const TriMesh& mesh, const Vec3d& shift, const std::string& note,
                const VertexAttributes& attributes) {
  check_mesh(file.string(), mesh, attributes);
  const bool normals = !mesh.normals.empty(), velocities = !mesh.velocities.empty();
  std::string head = fmt::format("ply\nformat binary_little_endian 1.0\ncomment dreampm surface, {}\n", note);
  head += ply_shift_comment(shift);
  head +=
      fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n", mesh.vertices.size());
  if (normals) head += "property float nx\nproperty float ny\nproperty float nz\n";
  if (velocities) head += "property float vx\nproperty float vy\nproperty float vz\n";
  head += ply_attribute_lines(attributes);
  head += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());

  replace_file(file, [&](const fs::path& temporary) {
    ByteSink out(temporary, file);
    out.text(head);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      out.value(mesh.vertices[i]);
      if (normals) out.value(mesh.normals[i]);
      if (velocities) out.value(mesh.velocities[i]);
      write_ply_attributes(out, attributes, i);
    }
    for (const auto& t : mesh.triangles) {
      out.value(std::uint8_t(3));
      out.value(t);
    }
    out.close();
  });
}

TriMesh read_mesh(const fs::path& file, VertexAttributes* attributes) {
  const std::string text = read_unpacked(file);
  PlyValues body(text, file.string());
  const PlyElement* const vertex = body.header().find("vertex");
  const PlyElement* const face = body.header().find("face");
  if (!vertex) fail_input("{}: no element \"vertex\"", body.file());
  if (!face) fail_input("{}: no element \"face\": particles, not a mesh", body.file());
  TriMesh mesh;
  for (const PlyElement& e : body.header().elements) {
    if (&e == vertex)
      read_vertices(body, e, mesh, attributes);
    else if (&e == face)
      read_faces(body, e, vertex->count, mesh);
    else
      for (std::uint64_t row = 0; row < e.count; ++row) body.skip_row(e, row);
  }
  body.expect_end();
  return mesh;
}

std::string obj_vertex(const Vec3f& v, const Vec3d& shift) {
  if (shift == Vec3d{}) return fmt::format("v {} {} {}\n", v.x, v.y, v.z);
  return fmt::format("v {} {} {}\n", v.x + shift.x, v.y + shift.y, v.z + shift.z);
}

void write_obj(const fs::path& file, const TriMesh& mesh, const Vec3d& shift, const std::string& note,
               const VertexAttributes& attributes) {
  check_mesh(file.string(), mesh, attributes);
  const bool normals = !mesh.normals.empty();
  const VertexAttribute* const color = find_attribute(attributes, "color");
  replace_file(file, [&](const fs::path& temporary) {
    ByteSink out(temporary, file);
    out.text(fmt::format("# dreampm surface, {}\n", note));
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      std::string line = obj_vertex(mesh.vertices[i], shift);
      if (color) {
        line.pop_back();
        for (std::size_t c = 0; c < 3; ++c) line += fmt::format(" {:.4f}", srgb_from_linear(color->values[3 * i + c]));
        line += '\n';
      }
      out.text(line);
    }
    for (const Vec3f& v : mesh.normals) out.text(fmt::format("vn {} {} {}\n", v.x, v.y, v.z));
    for (const auto& t : mesh.triangles) {  // OBJ counts from 1
      if (normals)
        out.text(fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", t[0] + 1, t[1] + 1, t[2] + 1));
      else
        out.text(fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1));
    }
    out.close();
  });
}

}  // namespace dreampm
