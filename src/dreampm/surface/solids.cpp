#include "dreampm/surface/solids.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/region.h"
#include "dreampm/surface/lattice.h"
#include "dreampm/surface/open_share.h"

namespace dreampm::surface {

Solids::Solids(std::span<const WettedSolid> solids, const Vec3d& origin, float reach)
    : origin_(origin), reach_(reach), step_(0.05f * reach) {
  for (const WettedSolid& s : solids) solids_.push_back({s, standing_bounds(s)});
}

Box3d Solids::standing_bounds(const WettedSolid& solid) const {
  const Box3d own = solid.region->bounds();
  if (solid.pose == Pose{}) return own;
  Box3d all;
  for (int c = 0; c < 8; ++c) {
    const Vec3d p{c & 1 ? own.max.x : own.min.x, c & 2 ? own.max.y : own.min.y, c & 4 ? own.max.z : own.min.z};
    all.add(solid.pose(p));
  }
  constexpr double endless = 1e30;
  if (!is_finite(own.min) || !is_finite(own.max))
    all.min = {-endless, -endless, -endless}, all.max = {endless, endless, endless};
  return all;
}

bool Solids::near(const Box3f& box) const {
  const Vec3d far{static_cast<double>(reach_), static_cast<double>(reach_), static_cast<double>(reach_)};
  const Vec3d low = Vec3d(box.min) + origin_ - far, high = Vec3d(box.max) + origin_ + far;
  return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& s) {
    for (int a = 0; a < 3; ++a)
      if (high[a] < s.bounds.min[a] || low[a] > s.bounds.max[a]) return false;
    return true;
  });
}

float Solids::distance(const Vec3f& p) const {
  double d = static_cast<double>(reach_);
  const Vec3d at = Vec3d(p) + origin_;
  for (const Solid& s : solids_) d = std::min(d, s.of.region->distance(s.of.pose.inverse(at)));
  return static_cast<float>(d);
}

Vec3f Solids::slope(const Vec3f& p) const {
  Vec3f g;
  for (int a = 0; a < 3; ++a) {
    Vec3f to = p, from = p;
    to[a] += step_, from[a] -= step_;
    g[a] = (distance(to) - distance(from)) / (2 * step_);
  }
  return g;
}

Vec3f Solids::normal(const Vec3f& p) const {
  const Vec3f g = slope(p);
  const float l = length(g);
  return l > 0 ? g / l : Vec3f{};
}

void Solids::distances(const Vec3f& first, float step, int count, float* to) const {
  const auto n = static_cast<std::size_t>(count), all = n * n * n;
  std::array<std::vector<double>, 3> place;
  for (auto& column : place) column.resize(all);
  std::vector<double> d(all);
  std::fill(to, to + all, reach_);
  const Vec3d corner = Vec3d(first) + origin_;
  const auto step_in = static_cast<double>(step);
  for (const Solid& s : solids_) {
    std::size_t i = 0;
    for (int z = 0; z < count; ++z)
      for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x, ++i) {
          const Vec3d p = s.of.pose.inverse(corner + Vec3d(Vec3i{x, y, z}) * step_in);
          place[0][i] = p.x, place[1][i] = p.y, place[2][i] = p.z;
        }
    s.of.region->distances({{place[0].data(), place[1].data(), place[2].data()}, all}, d.data());
    for (i = 0; i < all; ++i) to[i] = std::min(to[i], static_cast<float>(d[i]));
  }
}

Vec3f Solids::projected(Vec3f p, float off) const {
  for (int round = 0; round < 4; ++round) {
    const Vec3f g = slope(p);
    const float g2 = length2(g);
    if (g2 < 0.04f) break;  // amid solids
    p += g * ((off - distance(p)) / g2);
  }
  return p;
}

float Solids::depth(const Vec3f& p, const Vec3f& n, float wanted) const {
  constexpr int steps = 6;
  constexpr float share = 0.6f;  // of the way to the middle of a thin one
  const float step = wanted / steps;
  float before = distance(p);
  for (int k = 1; k <= steps; ++k) {
    const float d = distance(p - n * (step * static_cast<float>(k)));
    if (before - d < 0.3f * step) return share * step * static_cast<float>(k - 1);
    before = d;
  }
  return wanted;
}

bool Solids::clear_of(const Box3f& box) const {
  if (!near(box)) return true;
  const Vec3f quarter = box.size() * 0.25f;
  const float enough = 1.05f * length(quarter);
  if (enough >= 0.99f * reach_) return false;
  for (int c = 0; c < 8; ++c) {
    const Vec3f middle{c & 1 ? box.max.x - quarter.x : box.min.x + quarter.x,
                       c & 2 ? box.max.y - quarter.y : box.min.y + quarter.y,
                       c & 4 ? box.max.z - quarter.z : box.min.z + quarter.z};
    if (distance(middle) < enough) return false;
  }
  return true;
}

SolidBand::SolidBand(const SparseField& field, const Solids& solids) {
  if (solids.empty()) return;
  slot_.assign(field.leaves.size(), -1);
  std::vector<std::uint32_t> leaves;
  const float width = SparseField::kWidth * field.voxel;
  for (std::size_t l = 0; l < field.leaves.size(); ++l) {
    const Vec3f corner = field.point(field.leaves[l] * SparseField::kWidth);
    if (!solids.near({corner, corner + Vec3f{width, width, width}})) continue;
    slot_[l] = static_cast<std::int32_t>(leaves.size());
    leaves.push_back(static_cast<std::uint32_t>(l));
  }
  values_.resize(leaves.size() * kValues);
  std::vector<std::uint8_t> reached(leaves.size());
  parallel_for(leaves.size(), 4, [&](std::size_t i) {
    float* const to = values_.data() + i * kValues;
    const Vec3i first = field.leaves[leaves[i]] * SparseField::kWidth - Vec3i{1, 1, 1};
    solids.distances(field.point(first), field.voxel, kBlock, to);
    reached[i] = std::any_of(to, to + kValues, [&](float d) { return d < 0.99f * solids.reach(); });
  });
  for (std::size_t i = 0; i < leaves.size(); ++i)
    if (reached[i] == 0) slot_[leaves[i]] = -1;
}

namespace {

/// The values of a field before it is changed, and between its points.
class Values {
 public:
  explicit Values(const SparseField& field) : field_(field), leaves_(field.leaves.size() + field.inside.size()) {
    for (std::size_t i = 0; i < field.leaves.size(); ++i) leaves_.insert(field.leaves[i], static_cast<std::int32_t>(i));
    for (const Vec3i& l : field.inside) leaves_.insert(l, kInside);
  }
  float operator()(const Vec3f& p) const {
    const Vec3f u = (p - field_.origin) / field_.voxel;
    const Vec3i i = lattice_cell(u, 1);
    const Vec3f f = u - Vec3f(i);
    float sum = 0;
    for (int c = 0; c < 8; ++c) {
      const Vec3i o{c & 1, c >> 1 & 1, c >> 2 & 1};
      sum += (o.x ? f.x : 1 - f.x) * (o.y ? f.y : 1 - f.y) * (o.z ? f.z : 1 - f.z) * at(i + o);
    }
    return sum;
  }

 private:
  static constexpr std::int32_t kInside = 1 << 30;
  float at(const Vec3i& p) const {
    const std::int32_t l = leaves_.find({p.x >> 3, p.y >> 3, p.z >> 3});
    if (l == LatticeMap::kAbsent) return 0;
    return l == kInside ? 1
                        : field_.leaf(static_cast<std::size_t>(
                              l))[static_cast<std::size_t>(((p.z & 7) * 8 + (p.y & 7)) * 8 + (p.x & 7))];
  }
  const SparseField& field_;
  LatticeMap leaves_;
};

/// What a point near a solid gets.
class Filling {
 public:
  Filling(const SparseField& field, const Solids& solids, const OpenShare& open, float spacing)
      : field_(field), solids_(solids), open_(open), value_(field), spacing_(spacing) {}

  /// Values of a leaf. `distance`: its block of the band.
  void leaf(std::size_t l, const float* distance, float* to) const {
    constexpr int kB = SolidBand::kBlock;
    const auto own = field_.leaf(l);
    for (int i = 0; i < SparseField::kPoints; ++i) {
      const Vec3i at{i & 7, i >> 3 & 7, i >> 6};
      const float* const d = distance + ((at.z + 1) * kB + at.y + 1) * kB + at.x + 1;
      const Vec3f slope{d[1] - d[-1], d[kB] - d[-kB], d[kB * kB] - d[-kB * kB]};
      const auto n = static_cast<std::size_t>(i);
      to[i] = filled(own[n], field_.point(field_.leaves[l] * 8 + at), *d, slope / (2 * field_.voxel));
    }
  }

 private:
  float filled(float own, const Vec3f& p, float d, const Vec3f& slope) const {
    if (d >= 0.99f * solids_.reach()) return own;
    const float steep = length(slope);
    const Vec3f n = steep > 0 ? slope / steep : Vec3f{};
    const float sure = std::clamp(4 * steep - 2, 0.0f, 1.0f);  // amid solids the mirror is anyone's guess
    if (d <= 0) {
      const float sum = own + sure * value_(p - n * (2 * d));
      return std::min(sum, field_.iso + d / (4 * spacing_));
    }
    const float thick = sure > 0 ? sure * thick_below(p, n, d) : 0;
    const float both = own + (thick > 0 ? thick * value_(p - n * (2 * d)) : 0);
    return std::max(both, own / std::max(open_.at(p), kLeastOpen));
  }
  /// 1 where the mirror image of a point lies as deep in the solid as it lies before it; 0 where it
  /// would lie beyond a thin one.
  float thick_below(const Vec3f& p, const Vec3f& n, float d) const {
    const float deep = std::max(d, 0.4f * spacing_);
    return std::clamp((-solids_.distance(p - n * (d + deep)) / deep - 0.25f) * 2, 0.0f, 1.0f);
  }

  static constexpr float kLeastOpen = 0.15f;
  const SparseField& field_;
  const Solids& solids_;
  const OpenShare& open_;
  Values value_;
  float spacing_;
};

}  // namespace

void fill_solids(SparseField& field, const SolidBand& band, const Solids& solids, float spacing) {
  if (band.empty()) return;
  std::vector<std::size_t> leaves;
  std::vector<Box3f> boxes;
  const float width = SparseField::kWidth * field.voxel;
  for (std::size_t l = 0; l < field.leaves.size(); ++l) {
    if (band.block(l) == nullptr) continue;
    leaves.push_back(l);
    const Vec3f corner = field.point(field.leaves[l] * SparseField::kWidth);
    boxes.push_back({corner, corner + Vec3f{width, width, width}});
  }
  const OpenShare open(solids, boxes, spacing, 4 * spacing);
  const Filling filling(field, solids, open, spacing);
  std::vector<float> filled(leaves.size() * SparseField::kPoints);
  parallel_for(leaves.size(), 4, [&](std::size_t i) {
    filling.leaf(leaves[i], band.block(leaves[i]), filled.data() + i * SparseField::kPoints);
  });
  parallel_for(leaves.size(), 64, [&](std::size_t i) {
    const float* const from = filled.data() + i * SparseField::kPoints;
    std::copy(from, from + SparseField::kPoints, field.leaf(leaves[i]).begin());
  });
}

}  // namespace dreampm::surface
