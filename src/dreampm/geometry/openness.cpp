#include "dreampm/geometry/openness.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace dreampm {
namespace {

/// For every vertex the first one at its place.
std::vector<std::uint32_t> by_place(const std::vector<Vec3f>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), same(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t v) { return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z, v); };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return place(a) < place(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    same[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? same[order[i - 1]] : order[i];
  return same;
}

std::uint32_t root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

}  // namespace

Openness openness(const TriMesh& mesh) {
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
  std::map<std::uint32_t, Box3f> holes;
  for (const std::uint32_t v : rim) holes[root(parent, v)].add(mesh.vertices[v]);
  out.holes = holes.size();
  for (const auto& [v, box] : holes) {
    const Vec3f s = box.size();
    out.widest = std::max(out.widest, static_cast<double>(std::max({s.x, s.y, s.z})));
  }
  return out;
}

}  // namespace dreampm
