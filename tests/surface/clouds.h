// Particle sets for the tests: liquid on a jittered lattice of spacing h.
#pragma once
#include <map>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/math/rng.h"
#include "dreampm/math/vec.h"

namespace dreampm::test {

/// Points of the jittered lattice within the box [0, size] for which keep(p) holds.
template <class Keep>
std::vector<Vec3f> lattice(float h, const Vec3f& size, const Keep& keep, float jitter = 0.35f, std::uint64_t seed = 1) {
  std::vector<Vec3f> points;
  const auto count = [&](float s) { return static_cast<int>(std::lround(s / h)); };
  std::uint64_t n = 0;
  for (int k = 0; k < count(size.z); ++k)
    for (int j = 0; j < count(size.y); ++j)
      for (int i = 0; i < count(size.x); ++i) {
        const auto off = [&] { return 0.5f + jitter * (2 * static_cast<float>(uniform(seed, n++)) - 1); };
        const float x = off(), y = off(), z = off();
        const Vec3f p{h * (static_cast<float>(i) + x), h * (static_cast<float>(j) + y),
                      h * (static_cast<float>(k) + z)};
        if (keep(p)) points.push_back(p);
      }
  return points;
}

struct Topology {
  std::size_t open_edges = 0;   ///< directed edges without exactly one opposite
  std::size_t broken_fans = 0;  ///< vertices whose triangles do not form one ring
  std::size_t components = 0;
  bool closed() const { return open_edges == 0 && broken_fans == 0; }
};

inline Topology topology(const TriMesh& mesh) {
  Topology t;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::vector<std::map<std::uint32_t, std::uint32_t>> fan(mesh.vertices.size());
  std::vector<std::size_t> corners(mesh.vertices.size(), 0);
  std::vector<std::uint32_t> root(mesh.vertices.size());
  for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = v;
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& tri : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = tri[k], b = tri[(k + 1) % 3], c = tri[(k + 2) % 3];
      ++edges[{a, b}];
      fan[a][b] = c;
      ++corners[a];
      root[find(a)] = find(b);
    }
  for (const auto& [edge, n] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (n != 1 || back == edges.end() || back->second != 1) ++t.open_edges;
  }
  for (std::size_t v = 0; v < fan.size(); ++v) {
    if (fan[v].empty()) {
      ++t.broken_fans;
      continue;
    }
    std::size_t steps = 0;
    const std::uint32_t start = fan[v].begin()->first;
    std::uint32_t at = start;
    do {
      const auto next = fan[v].find(at);
      if (next == fan[v].end()) break;
      at = next->second;
      ++steps;
    } while (at != start && steps <= corners[v]);
    if (at != start || steps != corners[v]) ++t.broken_fans;
  }
  for (std::uint32_t v = 0; v < root.size(); ++v) t.components += find(v) == v;
  return t;
}

}  // namespace dreampm::test
