#include "dreampm/surface/attributes.h"

#include <algorithm>
#include <optional>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/linear_fit.h"

namespace dreampm::surface {
namespace {

/// The outward normal of the wall, if the vertex lies on one wall and on nothing else.
std::optional<Vec3f> wall_normal(const QuadMesh& quads, std::size_t v) {
  if (!quads.pure_wall(v) || (quads.touches[v] & QuadMesh::kSolid) != 0) return std::nullopt;
  std::optional<Vec3f> normal;
  for (int s = 0; s < 6; ++s) {
    if ((quads.touches[v] >> s & 1) == 0) continue;
    if (normal) return std::nullopt;
    normal = Vec3f{};
    (*normal)[s / 2] = s % 2 == 0 ? -1.0f : 1.0f;
  }
  return normal;
}

/// A face lies in a wall or a solid if all its corners touch one.
bool in_wall(const QuadMesh& quads, const std::array<std::uint32_t, 4>& q) {
  return (quads.touches[q[0]] & quads.touches[q[1]] & quads.touches[q[2]] & quads.touches[q[3]] & ~QuadMesh::kFree) !=
         0;
}

}  // namespace

TriMesh finish(const QuadMesh& quads) {
  TriMesh mesh;
  mesh.vertices = quads.vertices;
  mesh.triangles.resize(2 * quads.quads.size());
  const auto& x = mesh.vertices;
  parallel_for(quads.quads.size(), 8192, [&](std::size_t i) {
    const auto& q = quads.quads[i];
    const std::size_t turn = length2(x[q[0]] - x[q[2]]) <= length2(x[q[1]] - x[q[3]]) ? 0 : 1;
    mesh.triangles[2 * i] = {q[turn], q[turn + 1], q[turn + 2]};
    mesh.triangles[2 * i + 1] = {q[turn], q[turn + 2], q[(turn + 3) % 4]};
  });
  mesh.normals.assign(x.size(), Vec3f{});
  for (const auto& q : quads.quads) {
    const Vec3f area = cross(x[q[2]] - x[q[0]], x[q[3]] - x[q[1]]);
    const bool wall = in_wall(quads, q);
    for (const std::uint32_t v : q)
      if (!wall || quads.pure_wall(v)) mesh.normals[v] += area;
  }
  parallel_for(x.size(), 8192, [&](std::size_t v) {
    if (const auto wall = wall_normal(quads, v)) mesh.normals[v] = *wall;
    const float l = length(mesh.normals[v]);
    mesh.normals[v] = l > 0 ? mesh.normals[v] / l : Vec3f{0, 1, 0};
  });
  return mesh;
}

void carry_velocities(TriMesh& mesh, std::span<const Vec3f> positions, std::span<const Vec3f> velocities,
                      const CellGrid& grid) {
  mesh.velocities.assign(mesh.vertices.size(), Vec3f{});
  const float radius = 1.5f * grid.size;
  parallel_for(mesh.vertices.size(), 512, [&](std::size_t v) {
    const Vec3f x = mesh.vertices[v], reach{radius, radius, radius};
    LinearFit fit(radius);
    for_cells(grid, x - reach, x + reach, [&](std::size_t cell) {
      for (std::uint32_t i = grid.first[cell]; i < grid.first[cell + 1]; ++i) {
        const std::size_t p = grid.order[i];
        if (p < velocities.size()) fit.add(positions[p] - x, velocities[p]);  // else a mirror image
      }
    });
    if (!fit.empty()) mesh.velocities[v] = fit.velocity();
  });
}

double enclosed_volume(const TriMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3d from(mesh.vertices.front());  // near the mesh, else digits cancel
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = Vec3d(mesh.vertices[t[0]]) - from, b = Vec3d(mesh.vertices[t[1]]) - from,
                c = Vec3d(mesh.vertices[t[2]]) - from;
    six += dot(a, cross(b, c));
  }
  return six / 6;
}

}  // namespace dreampm::surface
