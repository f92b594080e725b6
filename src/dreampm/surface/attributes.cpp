#include "dreampm/surface/attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/linear_fit.h"
#include "dreampm/surface/neighbors.h"

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

/// Particles in the order of a grid's cells; their mirror images are far away.
class Movers {
 public:
  Movers(std::span<const Vec3f> positions, std::span<const Vec3f> velocities, const CellGrid& grid)
      : places_(grid, [&](std::uint32_t i) -> const Vec3f& { return i < velocities.size() ? positions[i] : kNowhere; }),
        lanes_(grid.order.size()) {
    for (std::vector<float>* column : {&places_.x, &places_.y, &places_.z}) column->resize(lanes_.size() + kLanes);
    parallel_for(lanes_.size(), 8192, [&](std::size_t k) {
      const std::size_t p = grid.order[k];
      if (p >= velocities.size()) return;
      const Vec3f &x = positions[p], &v = velocities[p];
      lanes_[k] = {1, x.x, x.y, x.z, v.x, v.y, v.z, 0};
    });
  }
  /// Adds those from `begin` to `end` to a fit around x.
  DM_WIDE void add(std::size_t begin, std::size_t end, const Vec3f& x, float radius, LinearFit& fit) const {
    LinearFit sum = fit;
    const Wide from = {0, x.x, x.y, x.z, 0, 0, 0, 0};
    const float radius2 = radius * radius;
    for (std::size_t k = begin; k < end; k += kLanes) {
      Wide dx, dy, dz;
      load(&places_.x[k], dx), load(&places_.y[k], dy), load(&places_.z[k], dz);
      dx -= x.x, dy -= x.y, dz -= x.z;
      const Wide t = 1 - (dx * dx + dy * dy + dz * dz) / radius2;
      unsigned bits = lane_bits(t > 0);
      if (end - k < kLanes) bits &= (1u << (end - k)) - 1;
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(bits));
        Wide p;
        load(lanes_[k + lane].data(), p);
        sum.add_lanes(p - from, t[lane]);
      }
    }
    fit = sum;
  }

 private:
  static constexpr Vec3f kNowhere{1e15f, 1e15f, 1e15f};  // its square is still a finite float
  SortedPlaces places_;
  std::vector<std::array<float, kLanes>> lanes_;  ///< 1, position, velocity, 0
};

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
  const Movers movers(positions, velocities, grid);
  parallel_for(mesh.vertices.size(), 512, [&](std::size_t v) {
    LinearFit fit(radius);
    for_rows_of_ball(grid, mesh.vertices[v], radius, [&](std::size_t first, std::size_t end) {
      movers.add(grid.first[first], grid.first[end], mesh.vertices[v], radius, fit);
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
