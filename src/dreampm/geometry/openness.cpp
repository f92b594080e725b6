#include "dreampm/geometry/openness.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace dreampm {
namespace {

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

}  // namespace

Openness openness(const Model& mesh) {
  const std::vector<std::uint32_t> vertex = by_place(mesh.vertices);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = vertex[t[k]], b = vertex[t[(k + 1) % 3]];
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());

  Openness out;
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  std::vector<std::uint32_t> rim;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    ++out.edges;
    if (end - i == 1) {
      ++out.open_edges;
      const auto [a, b] = edges[i];
      rim.insert(rim.end(), {a, b});
      parent[root(parent, a)] = root(parent, b);
    }
    i = end;
  }
  std::map<std::uint32_t, Box3d> holes;
  for (const std::uint32_t v : rim) holes[root(parent, v)].add(mesh.vertices[v]);
  out.holes = holes.size();
  for (const auto& [v, box] : holes) {
    const Vec3d s = box.size();
    out.widest = std::max({out.widest, s.x, s.y, s.z});
  }
  return out;
}

Openness openness(const TriMesh& mesh) { return openness(model_of(mesh)); }

}  // namespace dreampm
