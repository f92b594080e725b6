// Colliders that the liquid wets: where the surface of the particles ends at them, and how it is
// brought there.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "dreampm/geometry/region.h"
#include "dreampm/surface/sparse_field.h"
#include "dreampm/surface/surface.h"
#include "dreampm/surface/walls.h"

namespace dreampm::surface {

/// Solids as seen from the positions of the particles, which count from `origin` in the axes of the
/// solids. Distances are those to the nearest solid, negative inside, exact within `reach` [m] and
/// at most that beyond.
class Solids {
 public:
  Solids() = default;
  Solids(std::span<const WettedSolid> solids, const Vec3d& origin, float reach);

  bool empty() const { return solids_.empty(); }
  float reach() const { return reach_; }
  float distance(const Vec3f& p) const;
  /// The direction away from the nearest solid, of length 1; 0 where no distance changes.
  Vec3f normal(const Vec3f& p) const;
  /// Computes the distances at many points, to the same bits.
  void distances(std::span<const Vec3f> points, float* to) const;
  /// The same at points of a lattice, counted in steps [m] from `first`.
  void distances(const Vec3f& first, float step, std::span<const Vec3i> points, float* to) const;
  /// False where all of a box is farther than `reach` from the bounds of every solid.
  bool near(const Box3f& box) const;
  /// True where no solid reaches into the box.
  bool clear_of(const Box3f& box) const;
  /// The point of the surface nearest to p, where p lies near it: at distance `off` [m] of it.
  Vec3f projected(Vec3f p, float off) const;
  /// The way by which a mesh reaches into the solid at a point of its surface.
  struct WayIn {
    Vec3f out;    ///< the way goes against that direction, of length 1
    float depth;  ///< m
    bool whole;   ///< true if it ends as deep as wanted
  };
  /// The way at the point p, of normal n: as far from the surface as `wanted` [m], against n or, at
  /// convex edges, away from them; where the solid is thin a part of the way to its middle.
  WayIn way_in(const Vec3f& p, const Vec3f& n, float wanted) const;

 private:
  struct Solid {
    WettedSolid of;
    Box3d bounds;  ///< m, as it stands
  };
  /// The points that are asked for together, at most.
  static constexpr std::size_t at_once = 64;
  template <class Place>
  void ask_at(std::size_t count, const Place& place, float* to) const;
  /// `points`: in the axes of the solids.
  void ask(const PointColumns& points, float* to) const;
  Box3d standing_bounds(const WettedSolid& solid) const;

  std::vector<Solid> solids_;
  Vec3d origin_;
  float reach_ = 0, step_ = 0;
};

/// Distances to solids at the points of a field's leaves.
class SolidBand {
 public:
  SolidBand() = default;
  SolidBand(const SparseField& field, const Solids& solids);

  bool empty() const { return values_.empty(); }
  /// Values of a block of 10^3 points: those of a leaf, and one more on each side. Null where no
  /// solid is within reach of the leaf.
  static constexpr int kBlock = SparseField::kWidth + 2;
  const float* block(std::size_t leaf) const { return slot_[leaf] < 0 ? nullptr : at(slot_[leaf]); }
  /// The value at a point of a leaf; far outside where there is none.
  float distance(std::size_t leaf, const Vec3i& local) const {
    const float* const b = empty() ? nullptr : block(leaf);
    return b == nullptr ? 1e30f : b[((local.z + 1) * kBlock + local.y + 1) * kBlock + local.x + 1];
  }

 private:
  static constexpr std::size_t kValues = std::size_t{kBlock} * kBlock * kBlock;
  const float* at(std::int32_t slot) const { return values_.data() + static_cast<std::size_t>(slot) * kValues; }

  std::vector<std::int32_t> slot_;
  std::vector<float> values_;
};

/// Makes the field at a solid what it would be if the solid were more of the liquid beside it: a
/// point gets what its mirror image in the solid's surface has too, as flat walls give it; and
/// where that falls short, in corners, its own value over the share of a kernel there that no solid
/// takes. Inside of solids the field ends as beyond walls.
void fill_solids(SparseField& field, const SolidBand& band, const Solids& solids, float spacing);

}  // namespace dreampm::surface
