#include "dreampm/surface/contour.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/surface/dual_table.h"
#include "dreampm/surface/lattice.h"
#include "dreampm/surface/leaf_values.h"

namespace dreampm::surface {
namespace {

constexpr DualTable kTable = make_dual_table();
constexpr int kW = SparseField::kWidth, kBlock = kW + 1;
constexpr float kLift = 0.02f;

constexpr std::size_t cell_in_leaf(const Vec3i& p) { return static_cast<std::size_t>((p.z * kW + p.y) * kW + p.x); }
constexpr std::size_t in_block(const Vec3i& p) { return static_cast<std::size_t>((p.z * kBlock + p.y) * kBlock + p.x); }
constexpr Vec3i corner_offset(int c) { return {c & 1, c >> 1 & 1, c >> 2 & 1}; }
constexpr Vec3i unit(int axis) { return {axis == 0, axis == 1, axis == 2}; }
Vec3i local(const Vec3i& p) { return {p.x & 7, p.y & 7, p.z & 7}; }
static_assert(kW == 8, "leaf_of and local shift by 3 bits");

/// Cells, each with its lower corner in the leaf.
struct CellLeaf {
  Vec3i at;
  std::array<std::uint8_t, SparseField::kPoints> corners{};  ///< set of inside corners
  std::array<std::uint32_t, SparseField::kPoints> vertex{};  ///< number of the cell's first vertex
  std::vector<std::uint16_t> mixed;                          ///< cells that the surface crosses
};

class Contourer {
 public:
  Contourer(SparseField& field, const Bounds& bounds) : field_(field), bounds_(bounds), value_(field.leaves.size()) {
    for (std::size_t i = 0; i < field.leaves.size(); ++i) value_.insert(field.leaves[i], static_cast<std::int32_t>(i));
    inside_ = LatticeMap(field.inside.size());
    for (std::size_t i = 0; i < field.inside.size(); ++i) inside_.insert(field.inside[i], 0);
    std::vector<std::uint64_t> keys;
    keys.reserve(8 * field.leaves.size());
    for (const Vec3i& l : field.leaves)
      for (int c = 0; c < 8; ++c) keys.push_back(LatticeMap::key(l - corner_offset(c)));
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    cells_.resize(keys.size());
    cell_index_ = LatticeMap(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      cells_[i].at = LatticeMap::place(keys[i]);
      cell_index_.insert(cells_[i].at, static_cast<std::int32_t>(i));
    }
  }

  QuadMesh run() {
    parallel_for(cells_.size(), 32, [&](std::size_t i) { classify(cells_[i]); });
    while (raise_doubly_joined_faces()) {
    }
    QuadMesh mesh;
    number_vertices(mesh);
    parallel_for(cells_.size(), 32, [&](std::size_t i) { place_vertices(cells_[i], mesh); });
    make_quads(mesh);
    return mesh;
  }

 private:
  using Block = std::array<float, kBlock * kBlock * kBlock>;

  /// Values at the corners of a leaf's cells: its points and the first layer of the leaves after
  /// it.
  void load(const Vec3i& at, Block& block) const {
    for (int c = 0; c < 8; ++c) {
      const Vec3i o = corner_offset(c), leaf = at + o;
      const std::int32_t l = value_.find(leaf);
      const float constant = l == LatticeMap::kAbsent && inside_.find(leaf) != LatticeMap::kAbsent ? 1.0f : 0.0f;
      const float* values = l == LatticeMap::kAbsent ? nullptr : field_.leaf(static_cast<std::size_t>(l)).data();
      for (int z = 0; z < (o.z ? 1 : kW); ++z)
        for (int y = 0; y < (o.y ? 1 : kW); ++y)
          for (int x = 0; x < (o.x ? 1 : kW); ++x)
            block[in_block(Vec3i{x, y, z} + o * Vec3i{kW, kW, kW})] =
                values ? values[cell_in_leaf({x, y, z})] : constant;
    }
  }

  void classify(CellLeaf& leaf) const {
    Block block;
    load(leaf.at, block);
    leaf.mixed.clear();
    for (int z = 0; z < kW; ++z)
      for (int y = 0; y < kW; ++y)
        for (int x = 0; x < kW; ++x) {
          unsigned corners = 0;
          for (int c = 0; c < 8; ++c)
            corners |= static_cast<unsigned>(block[in_block(Vec3i{x, y, z} + corner_offset(c))] > field_.iso) << c;
          const std::size_t i = cell_in_leaf({x, y, z});
          leaf.corners[i] = static_cast<std::uint8_t>(corners);
          if (corners != 0 && corners != 255) leaf.mixed.push_back(static_cast<std::uint16_t>(i));
        }
  }

  const CellLeaf* leaf_at(const Vec3i& leaf) const {
    const std::int32_t i = cell_index_.find(leaf);
    return i == LatticeMap::kAbsent ? nullptr : &cells_[static_cast<std::size_t>(i)];
  }
  static Vec3i cell_place(const CellLeaf& leaf, std::size_t i) {
    const auto n = static_cast<std::int32_t>(i);
    return leaf.at * Vec3i{kW, kW, kW} + Vec3i{n & 7, n >> 3 & 7, n >> 6};
  }

  /// Two cells that both hold one sheet through all four edges of an ambiguous face would share one
  /// mesh edge twice (Wenger 2013, section 3.5). Makes one outside corner of each such face inside.
  /// False if there was none.
  bool raise_doubly_joined_faces() {
    std::vector<std::vector<Vec3i>> raise(cells_.size());
    parallel_for(cells_.size(), 32, [&](std::size_t n) {
      const CellLeaf& leaf = cells_[n];
      for (const std::uint16_t i : leaf.mixed) {
        const unsigned joined = kTable[leaf.corners[i]].joined;
        for (int a = 0; a < 3; ++a) {
          if ((joined >> (2 * a + 1) & 1) == 0) continue;
          const Vec3i p = cell_place(leaf, i), q = p + unit(a);
          const CellLeaf* other = leaf_at(leaf_of(q));
          if (!other || (kTable[other->corners[cell_in_leaf(local(q))]].joined >> (2 * a) & 1) == 0) continue;
          int c = 1 << a;  // the face's corners: q and q + b + c, or the other two
          if (leaf.corners[i] >> c & 1) c |= 1 << (a + 1) % 3;
          raise[n].push_back(p + corner_offset(c));
        }
      }
    });
    std::vector<std::uint8_t> stale(cells_.size(), 0);
    bool any = false;
    for (const auto& list : raise)
      for (const Vec3i& p : list) {
        any = true;
        const std::int32_t l = value_.find(leaf_of(p));
        if (l == LatticeMap::kAbsent)
          fail_run("the surface's field ends abruptly at grid point {} {} {}", p.x, p.y, p.z);
        field_.leaf(static_cast<std::size_t>(l))[cell_in_leaf(local(p))] = field_.iso + kLift;
        for (int c = 0; c < 8; ++c)
          if (const std::int32_t n = cell_index_.find(leaf_of(p - corner_offset(c))); n != LatticeMap::kAbsent)
            stale[static_cast<std::size_t>(n)] = 1;
      }
    parallel_for(cells_.size(), 32, [&](std::size_t n) {
      if (stale[n]) classify(cells_[n]);
    });
    return any;
  }

  void number_vertices(QuadMesh& mesh) {
    std::uint64_t n = 0;
    for (CellLeaf& leaf : cells_)
      for (const std::uint16_t i : leaf.mixed) {
        leaf.vertex[i] = static_cast<std::uint32_t>(n);
        n += kTable[leaf.corners[i]].patches;
      }
    if (n > 0xffffffffull) fail_run("the surface would have {} vertices, over 2^32: use a larger voxel", n);
    mesh.vertices.resize(n);
    mesh.touches.assign(n, 0);
    if (!bounds_.band.empty()) mesh.solid_normals.assign(n, Vec3f{});
  }

  void place_vertices(const CellLeaf& leaf, QuadMesh& mesh) const {
    if (leaf.mixed.empty()) return;
    Block block;
    load(leaf.at, block);
    for (const std::uint16_t i : leaf.mixed) {
      const DualTable::Entry& entry = kTable[leaf.corners[i]];
      const Vec3i p = cell_place(leaf, i), here = local(p);
      struct Mean {
        Vec3f sum{};
        float count = 0;
      };
      std::array<Mean, 4> free{}, on_wall{};
      for (int e = 0; e < 12; ++e) {
        const int patch = entry.patch[static_cast<std::size_t>(e)], a = edge_axis(e);
        if (patch < 0) continue;
        const Vec3i from = corner_offset(edge_base(e)), to = from + unit(a);
        const float f0 = block[in_block(here + from)], f1 = block[in_block(here + to)];
        Vec3f x = field_.point(p + from);
        const Vec3f end = field_.point(p + to);
        std::uint8_t& touches = mesh.touches[leaf.vertex[i] + static_cast<std::uint32_t>(patch)];
        const int wall = wall_crossed(a, x, end, f0 > f1);
        const std::optional<float> solid = solid_crossed(p + from, p + to, f0 > f1);
        if (wall >= 0) {
          x[a] = bounds_.walls.place(wall);
          touches = static_cast<std::uint8_t>(touches | 1u << wall);
        } else if (solid) {
          x[a] += (end[a] - x[a]) * *solid;
          touches |= QuadMesh::kSolid;
        } else {
          x[a] += (end[a] - x[a]) * std::clamp((field_.iso - f0) / (f1 - f0), 0.0f, 1.0f);
          touches |= QuadMesh::kFree;
        }
        // The height of a vertex where the surface meets a wall comes from the free edges alone:
        // wall edges would pull the line down in steps.
        auto& part =
            wall >= 0 || solid ? on_wall[static_cast<std::size_t>(patch)] : free[static_cast<std::size_t>(patch)];
        part.sum += x, part.count += 1;
      }
      for (std::size_t k = 0; k < entry.patches; ++k) {
        const Mean& mean = free[k].count > 0 ? free[k] : on_wall[k];
        const std::uint8_t touches = mesh.touches[leaf.vertex[i] + k];
        Vec3f x = mean.sum / mean.count;
        if (touches & QuadMesh::kSolid) {
          x = bounds_.solids.projected(x, 0);
          mesh.solid_normals[leaf.vertex[i] + k] = bounds_.solids.normal(x);
        }
        x = bounds_.walls.inside(x);
        for (int s = 0; s < 6; ++s)
          if (touches >> s & 1) x[s / 2] = bounds_.walls.place(s);
        mesh.vertices[leaf.vertex[i] + k] = x;
      }
    }
  }

  /// The wall between the two ends of an edge along `axis`, or -1. The end outside of the liquid
  /// lies on it or beyond.
  int wall_crossed(int axis, const Vec3f& from, const Vec3f& to, bool from_inside) const {
    const Vec3f& outer = from_inside ? to : from;
    for (int s = 2 * axis; s < 2 * axis + 2; ++s)
      if (bounds_.walls.closed[static_cast<std::size_t>(s)] && bounds_.walls.distance(s, outer) <= 0) return s;
    return -1;
  }
  /// Where an edge enters a solid, 0 at `from` to 1 at `to`, if its end outside of the liquid lies
  /// in one.
  std::optional<float> solid_crossed(const Vec3i& from, const Vec3i& to, bool from_inside) const {
    if (bounds_.band.empty()) return std::nullopt;
    const float d0 = solid_distance(from), d1 = solid_distance(to);
    if ((from_inside ? d1 : d0) > 0) return std::nullopt;
    return d0 == d1 ? 0.5f : std::clamp(d0 / (d0 - d1), 0.0f, 1.0f);
  }
  float solid_distance(const Vec3i& p) const {
    const std::int32_t l = value_.find(leaf_of(p));
    return l == LatticeMap::kAbsent ? 1e30f : bounds_.band.distance(static_cast<std::size_t>(l), local(p));
  }

  void make_quads(QuadMesh& mesh) const {
    std::vector<std::vector<std::array<std::uint32_t, 4>>> parts(cells_.size());
    std::vector<std::vector<Vec3i>> inner(cells_.size());
    parallel_for(cells_.size(), 32, [&](std::size_t n) {
      const CellLeaf& leaf = cells_[n];
      for (const std::uint16_t i : leaf.mixed) {
        const unsigned corners = leaf.corners[i];
        const Vec3i p = cell_place(leaf, i);
        for (int a = 0; a < 3; ++a) {
          const bool inside = corners & 1;
          if (inside == ((corners >> (1 << a) & 1) != 0)) continue;
          // Round the edge, counter-clockwise seen against the axis: the cell's own edge lies at
          // its (u, v) offset.
          const Vec3i b = unit((a + 1) % 3), c = unit((a + 2) % 3);
          const std::array<std::uint32_t, 4> v{vertex_of(p - b - c, 4 * a + 3), vertex_of(p - c, 4 * a + 2),
                                               vertex_of(p, 4 * a), vertex_of(p - b, 4 * a + 1)};
          inner[n].push_back(inside ? p : p + unit(a));
          parts[n].push_back(inside ? v : std::array<std::uint32_t, 4>{v[3], v[2], v[1], v[0]});
        }
      }
    });
    std::size_t total = 0;
    for (const auto& part : parts) total += part.size();
    mesh.quads.reserve(total);
    for (const auto& part : inner) mesh.inner.insert(mesh.inner.end(), part.begin(), part.end());
    for (const auto& part : parts) mesh.quads.insert(mesh.quads.end(), part.begin(), part.end());
  }
  std::uint32_t vertex_of(const Vec3i& cell, int edge) const {
    const CellLeaf* leaf = leaf_at(leaf_of(cell));
    if (!leaf) fail_run("the surface's field ends abruptly at grid cell {} {} {}", cell.x, cell.y, cell.z);
    const std::size_t i = cell_in_leaf(local(cell));
    return leaf->vertex[i] + static_cast<std::uint32_t>(kTable[leaf->corners[i]].patch[static_cast<std::size_t>(edge)]);
  }

  SparseField& field_;
  const Bounds& bounds_;
  LatticeMap value_, inside_, cell_index_;
  std::vector<CellLeaf> cells_;
};

}  // namespace

QuadMesh contour(SparseField& field, const Bounds& bounds) { return Contourer(field, bounds).run(); }

}  // namespace dreampm::surface
