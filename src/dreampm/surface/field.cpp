#include "dreampm/surface/field.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/wide.h"

namespace dreampm::surface {
namespace {

constexpr int kW = SparseField::kWidth;

/// The plan of leaves: where they are needed, and which of them lie wholly inside.
class LeafPlan {
 public:
  LeafPlan(const CellGrid& grid, const std::vector<std::uint8_t>& deep, const Walls& walls, const Solids& solids,
           const FieldSettings& s)
      : grid_(grid), deep_(deep), walls_(walls), solids_(solids), voxel_(s.voxel), width_(kW * s.voxel) {
    std::vector<std::uint64_t> keys;
    LatticeMap seen(grid.cells.size());
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      // All that a deep cell reaches lies within its neighbors, which ask for themselves.
      const float reach = deep[c] ? 0 : s.support;
      const Vec3f corner = Vec3f(grid.cells[c]) * grid.size, margin{reach, reach, reach};
      const Vec3f edge{grid.size, grid.size, grid.size};
      const Vec3i lo = lattice_cell(corner - margin, width_), hi = lattice_cell(corner + edge + margin, width_);
      for (int z = lo.z; z <= hi.z; ++z)
        for (int y = lo.y; y <= hi.y; ++y)
          for (int x = lo.x; x <= hi.x; ++x)
            if (const auto n = static_cast<std::int32_t>(keys.size()); seen.insert({x, y, z}, n) == n)
              keys.push_back(LatticeMap::key({x, y, z}));
    }
    std::sort(keys.begin(), keys.end());
    enum : std::uint8_t { kStored, kInside, kBeyond };
    std::vector<std::uint8_t> kind(keys.size());
    parallel_for(keys.size(), 256, [&](std::size_t i) {
      const Vec3i leaf = LatticeMap::place(keys[i]);
      kind[i] = beyond(leaf) ? kBeyond : inside(leaf) ? kInside : kStored;
    });
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (kind[i] == kStored) stored_.push_back(LatticeMap::place(keys[i]));
      if (kind[i] == kInside) inside_.push_back(LatticeMap::place(keys[i]));
    }
  }
  std::vector<Vec3i> stored_, inside_;

 private:
  Box3f bounds(const Vec3i& leaf, float margin) const {
    const Vec3f a = Vec3f(leaf) * width_, m{margin, margin, margin}, w{width_, width_, width_};
    return {a - m, a + w + m};
  }
  bool beyond(const Vec3i& leaf) const {
    const Box3f b = bounds(leaf, voxel_);
    for (int s = 0; s < 6; ++s)
      if (walls_.closed[static_cast<std::size_t>(s)] && walls_.distance(s, s % 2 == 0 ? b.max : b.min) < 0) return true;
    return false;
  }
  bool inside(const Vec3i& leaf) const {
    const Box3f b = bounds(leaf, voxel_);
    if (walls_.distance(b.min) <= 0 || walls_.distance(b.max) <= 0) return false;
    const Vec3i lo = lattice_cell(b.min, grid_.size), hi = lattice_cell(b.max, grid_.size);
    for (int z = lo.z; z <= hi.z; ++z)
      for (int y = lo.y; y <= hi.y; ++y)
        for (int x = lo.x; x <= hi.x; ++x) {
          const std::int32_t c = grid_.index.find({x, y, z});
          if (c == LatticeMap::kAbsent || !deep_[static_cast<std::size_t>(c)]) return false;
        }
    return solids_.clear_of(b);
  }
  const CellGrid& grid_;
  const std::vector<std::uint8_t>& deep_;
  const Walls& walls_;
  const Solids& solids_;
  float voxel_, width_;
};

/// A kernel and the box around its ellipsoid.
struct Blob {
  Kernel kernel;
  Vec3f half;
};

Blob blob_of(const Kernel& k) {
  // The ellipsoid x . A x = 1 reaches sqrt((A^-1)_ii) along axis i.
  const Mat3f a = k.form.full(), c = cofactor(a);
  const float per = 1 / determinant(a);
  return {k, {std::sqrt(c(0, 0) * per), std::sqrt(c(1, 1) * per), std::sqrt(c(2, 2) * per)}};
}

/// Along the rows of a plane of a leaf q^2 = a + b i + c i^2: a and b, row by row.
struct Rows {
  float a[kW], b[kW];
};

/// The rows of the plane `z` [m] off a kernel's center, whose first points lie at x and y [m] of
/// it.
[[gnu::always_inline]] inline void find_rows(const Sym3<float>& form, float x, const Wide& y, float z, float voxel,
                                             Rows& rows) {
  const Wide fx = form.xx * x + form.xy * y + form.xz * z, fy = form.xy * x + form.yy * y + form.yz * z,
             fz = form.xz * x + form.yz * y + form.zz * z;
  store(x * fx + y * fy + z * fz, rows.a), store(2 * voxel * fx, rows.b);
}

/// Adds kernels to the 8^3 values of the leaf whose first point is `corner`.
DM_WIDE void add_blobs(const Blob* begin, const Blob* end, const Vec3f& corner, const FieldSettings& s, float* values) {
  static_assert(kW == kLanes);
  const Wide steps = {0, 1, 2, 3, 4, 5, 6, 7};
  const float voxel = s.voxel, per_voxel = 1 / voxel, last = voxel * (kW - 1);
  const float far2 = 1.0001f * s.support * s.support;
  for (const Blob* blob = begin; blob != end; ++blob) {
    const Vec3f d = corner - blob->kernel.center, half = blob->half;
    // From the center to the leaf along each axis.
    const float ox = std::max(0.0f, std::max(d.x, -last - d.x)), oy = std::max(0.0f, std::max(d.y, -last - d.y)),
                oz = std::max(0.0f, std::max(d.z, -last - d.z));
    if (ox > half.x || oy > half.y || oz > half.z || ox * ox + oy * oy + oz * oz > far2) continue;
    const int y0 = std::max(0, static_cast<int>(std::ceil((-half.y - d.y) * per_voxel)));
    const int y1 = std::min(kW - 1, static_cast<int>(std::floor((half.y - d.y) * per_voxel)));
    const int z0 = std::max(0, static_cast<int>(std::ceil((-half.z - d.z) * per_voxel)));
    const int z1 = std::min(kW - 1, static_cast<int>(std::floor((half.z - d.z) * per_voxel)));
    const Sym3<float> form = blob->kernel.form;  // a copy stays in registers while values are written
    const Wide y_of = d.y + voxel * steps, c_steps = voxel * voxel * form.xx * steps,
               amount = Wide{} + blob->kernel.amount;
    Rows rows;
    for (int z = z0; z <= z1; ++z) {
      find_rows(form, d.x, y_of, d.z + voxel * static_cast<float>(z), voxel, rows);
      // Rows that miss the ellipsoid add 0: to find them costs more.
      for (int y = y0; y <= y1; ++y) {
        float* row = values + (z * kW + y) * kW;
        Wide sum, t = 1 - (rows.a[y] + steps * (rows.b[y] + c_steps));
        t = t > 0 ? t : Wide{};
        load(row, sum);
        sum += amount * t * t * t;
        store(sum, row);
      }
    }
  }
}

}  // namespace

SparseField make_field(const std::vector<Kernel>& kernels, const CellGrid& grid, const std::vector<std::uint8_t>& deep,
                       const Walls& walls, const Solids& solids, const FieldSettings& s) {
  SparseField field;
  field.voxel = s.voxel;
  LeafPlan plan(grid, deep, walls, solids, s);
  field.leaves = std::move(plan.stored_);
  field.inside = std::move(plan.inside_);
  field.values.assign(field.leaves.size() * SparseField::kPoints, 0.0f);
  std::vector<Blob> blobs(kernels.size());  // in cell order
  parallel_for(blobs.size(), 4096, [&](std::size_t i) { blobs[i] = blob_of(kernels[grid.order[i]]); });
  const float width = kW * s.voxel;
  parallel_for(field.leaves.size(), 4, [&](std::size_t l) {
    float* values = field.leaf(l).data();
    const Vec3f corner = Vec3f(field.leaves[l]) * width;
    const Vec3f margin{s.support, s.support, s.support}, edge{width, width, width};
    const Vec3i low = lattice_cell(corner - margin, grid.size), high = lattice_cell(corner + edge + margin, grid.size);
    for_rows(grid, low, high, [&](std::size_t cell, std::size_t end_cell) {
      add_blobs(blobs.data() + grid.first[cell], blobs.data() + grid.first[end_cell], corner, s, values);
    });
    if (std::min(walls.distance(corner), walls.distance(corner + edge)) > 8 * s.spacing) return;
    for (int i = 0; i < SparseField::kPoints; ++i) {
      const Vec3i at{i % kW, i / kW % kW, i / (kW * kW)};
      const float d = walls.distance(field.point(field.leaves[l] * Vec3i{kW, kW, kW} + at));
      if (d <= 0) values[i] = std::min(values[i], field.iso + d / (4 * s.spacing));
    }
  });
  return field;
}

}  // namespace dreampm::surface
