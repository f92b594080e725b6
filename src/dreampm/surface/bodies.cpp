#include "dreampm/surface/bodies.h"

#include <numeric>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/lattice.h"

namespace dreampm::surface {
namespace {

constexpr int kW = SparseField::kWidth;

/// Numbers that are joined to sets. `N`: of 32 bits, or of 64 where these are too few.
template <class N>
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), N{0}); }
  N find(N i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(N a, N b) {
    a = find(a), b = find(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<N> parent_;
};

template <class N>
Bodies find_bodies_by(const SparseField& field, const QuadMesh& mesh, std::span<const Vec3f> points) {
  constexpr N kNowhere = ~N{0};
  // Nodes: the stored points, then the inside leaves, then the vertices.
  const std::size_t stored = field.leaves.size() * SparseField::kPoints;
  const auto first_vertex = static_cast<N>(stored + field.inside.size());
  LatticeMap leaves(field.leaves.size() + field.inside.size());
  for (std::size_t i = 0; i < field.leaves.size(); ++i) leaves.insert(field.leaves[i], static_cast<std::int32_t>(i));
  for (std::size_t i = 0; i < field.inside.size(); ++i)
    leaves.insert(field.inside[i], static_cast<std::int32_t>(field.leaves.size() + i));
  /// The node of point `at` of a leaf, if it is inside.
  const auto node = [&](std::int32_t leaf, const Vec3i& at) {
    if (leaf == LatticeMap::kAbsent) return kNowhere;
    const auto l = static_cast<std::size_t>(leaf);
    if (l >= field.leaves.size()) return static_cast<N>(stored + l - field.leaves.size());
    const auto i = l * SparseField::kPoints + static_cast<std::size_t>((at.z * kW + at.y) * kW + at.x);
    return field.values[i] > field.iso ? static_cast<N>(i) : kNowhere;
  };
  Sets<N> sets(first_vertex + mesh.vertices.size());
  const auto all_leaves = field.leaves.size() + field.inside.size();
  for (std::size_t l = 0; l < all_leaves; ++l) {
    const auto own = static_cast<std::int32_t>(l);
    const bool solid = l >= field.leaves.size();
    const Vec3i place = solid ? field.inside[l - field.leaves.size()] : field.leaves[l];
    for (int a = 0; a < 3; ++a) {
      Vec3i step{a == 0, a == 1, a == 2};
      const std::int32_t next = leaves.find(place + step);
      for (int i = 0; i < SparseField::kPoints; ++i) {
        const Vec3i at{i % kW, i / kW % kW, i / (kW * kW)};
        const bool last = at[a] == kW - 1;
        if (solid && !last) continue;
        const N from = node(own, at);
        if (from == kNowhere) continue;
        const Vec3i to = at + step;
        const N other = last ? node(next, {to.x % kW, to.y % kW, to.z % kW}) : node(own, to);
        if (other != kNowhere) sets.join(from, other);
      }
    }
  }
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const Vec3i& p = mesh.inner[q];
    const N n = node(leaves.find({p.x >> 3, p.y >> 3, p.z >> 3}), {p.x & 7, p.y & 7, p.z & 7});
    for (const std::uint32_t v : mesh.quads[q]) sets.join(first_vertex + v, n);
  }

  Bodies bodies;
  std::vector<std::int32_t> number(first_vertex + mesh.vertices.size(), Bodies::kNone);
  bodies.of_vertex.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::int32_t& body = number[sets.find(first_vertex + static_cast<N>(v))];
    if (body == Bodies::kNone) {
      body = static_cast<std::int32_t>(bodies.count++);
      bodies.on_wall.push_back(0);
    }
    bodies.of_vertex[v] = body;
    if (mesh.on_wall(v)) bodies.on_wall[static_cast<std::size_t>(body)] = 1;
  }
  bodies.particles.assign(bodies.count, 0);
  bodies.of_particle.assign(points.size(), Bodies::kNone);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3f local = (points[i] - field.origin) / field.voxel;
    const Vec3i base = lattice_cell(local, 1);
    float nearest = 1e30f;
    N best = kNowhere;
    const auto try_cube = [&](int from, int to) {
      for (int dz = from; dz <= to; ++dz)
        for (int dy = from; dy <= to; ++dy)
          for (int dx = from; dx <= to; ++dx) {
            const Vec3i p = base + Vec3i{dx, dy, dz};
            const float d = length2(Vec3f(p) - local);
            if (d >= nearest) continue;
            const N n = node(leaves.find({p.x >> 3, p.y >> 3, p.z >> 3}), {p.x & 7, p.y & 7, p.z & 7});
            if (n != kNowhere) nearest = d, best = n;
          }
    };
    try_cube(0, 1);
    if (best == kNowhere) try_cube(-1, 2);
    if (best == kNowhere) continue;
    const std::int32_t body = number[sets.find(best)];
    if (body == Bodies::kNone) continue;
    bodies.of_particle[i] = body;
    ++bodies.particles[static_cast<std::size_t>(body)];
  }
  return bodies;
}

}  // namespace

Bodies find_bodies(const SparseField& field, const QuadMesh& mesh, std::span<const Vec3f> points,
                   std::size_t most_in_32_bits) {
  const std::size_t nodes = field.leaves.size() * SparseField::kPoints + field.inside.size() + mesh.vertices.size();
  return nodes <= most_in_32_bits ? find_bodies_by<std::uint32_t>(field, mesh, points)
                                  : find_bodies_by<std::uint64_t>(field, mesh, points);
}

}  // namespace dreampm::surface
