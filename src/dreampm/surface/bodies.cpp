#include "dreampm/surface/bodies.h"

#include <numeric>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/lattice.h"

namespace dreampm::surface {
namespace {

constexpr int kW = SparseField::kWidth;
constexpr std::size_t kLeafGrain = 16, kParticleGrain = 4096;

/// Numbers that are joined to sets, each named by the least of them. `N`: of 32 bits, or of 64
/// where these are too few.
template <class N>
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), N{0}); }
  N find(N i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The same without a shorter way for later.
  N look_up(N i) const {
    while (parent_[i] != i) i = parent_[i];
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

/// The connectivity of grid points inside of the surface, and of the vertices around them. Nodes
/// are the stored points, then the inside leaves, then the vertices.
template <class N>
class Connectivity {
 public:
  Connectivity(const SparseField& field, const QuadMesh& mesh)
      : field_(field),
        mesh_(mesh),
        stored_(field.leaves.size() * SparseField::kPoints),
        first_vertex_(static_cast<N>(stored_ + field.inside.size())),
        leaves_(field.leaves.size() + field.inside.size()),
        sets_(first_vertex_ + mesh.vertices.size()) {
    for (std::size_t i = 0; i < field.leaves.size(); ++i) leaves_.insert(field.leaves[i], static_cast<std::int32_t>(i));
    for (std::size_t i = 0; i < field.inside.size(); ++i)
      leaves_.insert(field.inside[i], static_cast<std::int32_t>(field.leaves.size() + i));
  }

  /// Joins neighbors along the axes, first those within a leaf: its nodes are no other leaf's.
  void join_lattice() {
    parallel_for(field_.leaves.size(), kLeafGrain, [&](std::size_t leaf) { join_within(leaf); });
    for (std::size_t leaf = 0; leaf < field_.leaves.size() + field_.inside.size(); ++leaf) join_across(leaf);
  }
  /// Joins the corners of each face with the point that it encloses.
  void join_mesh() {
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q) {
      const N inner = node_at(mesh_.inner[q]);
      for (const std::uint32_t v : mesh_.quads[q]) sets_.join(first_vertex_ + v, inner);
    }
  }
  /// Numbers the bodies in the order of their first vertex.
  void number_vertices(Bodies& bodies) {
    number_.assign(first_vertex_ + mesh_.vertices.size(), Bodies::kNone);
    bodies.of_vertex.resize(mesh_.vertices.size());
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      std::int32_t& body = number_[sets_.find(first_vertex_ + static_cast<N>(v))];
      if (body == Bodies::kNone) {
        body = static_cast<std::int32_t>(bodies.count++);
        bodies.on_wall.push_back(0);
      }
      bodies.of_vertex[v] = body;
      if (mesh_.on_wall(v)) bodies.on_wall[static_cast<std::size_t>(body)] = 1;
    }
  }
  /// Gives each particle to the body of the nearest point inside.
  void assign_particles(std::span<const Vec3f> points, Bodies& bodies) const {
    bodies.of_particle.assign(points.size(), Bodies::kNone);
    parallel_for(points.size(), kParticleGrain, [&](std::size_t i) {
      if (const N nearest = nearest_inside((points[i] - field_.origin) / field_.voxel); nearest != kNowhere)
        bodies.of_particle[i] = number_[sets_.look_up(nearest)];
    });
    bodies.particles.assign(bodies.count, 0);
    for (const std::int32_t body : bodies.of_particle)
      if (body != Bodies::kNone) ++bodies.particles[static_cast<std::size_t>(body)];
  }

 private:
  static constexpr N kNowhere = ~N{0};

  /// Returns the node of point `at` of a leaf, if it is inside.
  N node(std::int32_t leaf, const Vec3i& at) const {
    if (leaf == LatticeMap::kAbsent) return kNowhere;
    const auto l = static_cast<std::size_t>(leaf);
    if (l >= field_.leaves.size()) return static_cast<N>(stored_ + l - field_.leaves.size());
    const auto i = l * SparseField::kPoints + static_cast<std::size_t>((at.z * kW + at.y) * kW + at.x);
    return field_.values[i] > field_.iso ? static_cast<N>(i) : kNowhere;
  }
  /// Returns the node of a point of the lattice.
  N node_at(const Vec3i& p) const {
    return node(leaves_.find({p.x >> 3, p.y >> 3, p.z >> 3}), {p.x & 7, p.y & 7, p.z & 7});
  }
  static Vec3i point_of(int i) { return {i % kW, i / kW % kW, i / (kW * kW)}; }

  void join_within(std::size_t leaf) {
    const auto own = static_cast<std::int32_t>(leaf);
    for (int i = 0; i < SparseField::kPoints; ++i) {
      const Vec3i at = point_of(i);
      const N from = node(own, at);
      if (from == kNowhere) continue;
      for (int a = 0; a < 3; ++a) {
        if (at[a] == kW - 1) continue;
        if (const N to = node(own, at + Vec3i{a == 0, a == 1, a == 2}); to != kNowhere) sets_.join(from, to);
      }
    }
  }
  /// Joins a leaf with the leaves behind it along each axis.
  void join_across(std::size_t leaf) {
    const auto own = static_cast<std::int32_t>(leaf);
    const Vec3i place = leaf < field_.leaves.size() ? field_.leaves[leaf] : field_.inside[leaf - field_.leaves.size()];
    for (int a = 0; a < 3; ++a) {
      const std::int32_t next = leaves_.find(place + Vec3i{a == 0, a == 1, a == 2});
      if (next == LatticeMap::kAbsent) continue;
      for (int k = 0; k < kW * kW; ++k) {
        Vec3i at{}, to{};
        at[(a + 1) % 3] = to[(a + 1) % 3] = k % kW, at[(a + 2) % 3] = to[(a + 2) % 3] = k / kW, at[a] = kW - 1;
        const N from = node(own, at), other = node(next, to);
        if (from != kNowhere && other != kNowhere) sets_.join(from, other);
      }
    }
  }
  /// Returns the nearest inside node around a place in voxels, of the cube around it or one more on
  /// each side.
  N nearest_inside(const Vec3f& local) const {
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
            if (const N n = node_at(p); n != kNowhere) nearest = d, best = n;
          }
    };
    try_cube(0, 1);
    if (best == kNowhere) try_cube(-1, 2);
    return best;
  }

  const SparseField& field_;
  const QuadMesh& mesh_;
  std::size_t stored_;
  N first_vertex_;
  LatticeMap leaves_;
  Sets<N> sets_;
  std::vector<std::int32_t> number_;  ///< by node that names a set: its body
};

template <class N>
Bodies find_bodies_by(const SparseField& field, const QuadMesh& mesh, std::span<const Vec3f> points) {
  Connectivity<N> connectivity(field, mesh);
  connectivity.join_lattice();
  connectivity.join_mesh();
  Bodies bodies;
  connectivity.number_vertices(bodies);
  connectivity.assign_particles(points, bodies);
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
