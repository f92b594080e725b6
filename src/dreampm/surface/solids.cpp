#include "dreampm/surface/solids.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/geometry/region.h"
#include "dreampm/surface/lattice.h"
#include "dreampm/surface/leaf_values.h"
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

namespace {

/// True where a box is more than `reach` from another along some axis.
bool apart(const Box3d& a, const Box3d& b, double reach) {
  for (int k = 0; k < 3; ++k)
    if (a.max[k] + reach < b.min[k] || a.min[k] - reach > b.max[k]) return true;
  return false;
}

/// A place and those a step before and behind it along each axis, of which a gradient follows.
struct Probe {
  Probe(const Solids& solids, const Vec3f& p, float step) {
    std::array<Vec3f, 7> places;
    places.fill(p);
    for (int a = 0; a < 3; ++a) {
      const auto n = static_cast<std::size_t>(2 * a);
      places[n][a] += step, places[n + 1][a] -= step;
    }
    std::array<float, 7> d;
    solids.distances(places, d.data());
    distance = d[6];
    for (int a = 0; a < 3; ++a) {
      const auto n = static_cast<std::size_t>(2 * a);
      slope[a] = (d[n] - d[n + 1]) / (2 * step);
    }
  }
  float distance;  ///< m
  Vec3f slope;
};

}  // namespace

bool Solids::near(const Box3f& box) const {
  const Box3d at{Vec3d(box.min) + origin_, Vec3d(box.max) + origin_};
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const Solid& s) { return !apart(at, s.bounds, static_cast<double>(reach_)); });
}

float Solids::distance(const Vec3f& p) const {
  float d;
  distances({&p, 1}, &d);
  return d;
}

/// Asks for `count` points at place(i), in the axes of the solids.
template <class Place>
void Solids::ask_at(std::size_t count, const Place& place, float* to) const {
  std::array<double, 3 * at_once> at;
  for (std::size_t begin = 0; begin < count; begin += at_once) {
    const std::size_t some = std::min(at_once, count - begin);
    for (std::size_t i = 0; i < some; ++i) {
      const Vec3d p = place(begin + i);
      at[i] = p.x, at[at_once + i] = p.y, at[2 * at_once + i] = p.z;
    }
    ask({{&at[0], &at[at_once], &at[2 * at_once]}, some}, to + begin);
  }
}

void Solids::distances(std::span<const Vec3f> points, float* to) const {
  ask_at(points.size(), [&](std::size_t i) { return Vec3d(points[i]) + origin_; }, to);
}

void Solids::distances(const Vec3f& first, float step, std::span<const Vec3i> points, float* to) const {
  const Vec3d corner = Vec3d(first) + origin_;
  ask_at(points.size(), [&](std::size_t i) { return corner + Vec3d(points[i]) * static_cast<double>(step); }, to);
}

void Solids::ask(const PointColumns& points, float* to) const {
  Box3d box;
  for (std::size_t i = 0; i < points.count; ++i) box.add({points.at[0][i], points.at[1][i], points.at[2][i]});
  std::fill(to, to + points.count, reach_);
  std::array<double, 3 * at_once> own;
  std::array<double, at_once> d;
  for (const Solid& s : solids_) {
    if (apart(box, s.bounds, static_cast<double>(reach_))) continue;
    for (std::size_t i = 0; i < points.count; ++i) {
      const Vec3d p = s.of.pose.inverse({points.at[0][i], points.at[1][i], points.at[2][i]});
      own[i] = p.x, own[at_once + i] = p.y, own[2 * at_once + i] = p.z;
    }
    s.of.region->distances({{&own[0], &own[at_once], &own[2 * at_once]}, points.count}, d.data());
    for (std::size_t i = 0; i < points.count; ++i) to[i] = std::min(to[i], static_cast<float>(d[i]));
  }
}

Vec3f Solids::normal(const Vec3f& p) const {
  const Vec3f g = Probe(*this, p, step_).slope;
  const float l = length(g);
  return l > 0 ? g / l : Vec3f{};
}

Vec3f Solids::projected(Vec3f p, float off) const {
  for (int round = 0; round < 4; ++round) {
    const Probe at(*this, p, step_);
    const float g2 = length2(at.slope);
    if (g2 < 0.04f) break;  // amid solids
    p += at.slope * ((off - at.distance) / g2);
  }
  return p;
}

Solids::WayIn Solids::way_in(const Vec3f& p, const Vec3f& n, float wanted) const {
  constexpr int steps = 6;
  constexpr float share = 0.6f;  // of the way to the middle of a thin one
  constexpr float least = 0.3f;  // that a distance changes by over the way; less: a middle
  const float step = wanted / steps;
  std::array<Vec3f, steps + 1> places;
  places[0] = p;
  for (int k = 1; k <= steps; ++k) places[static_cast<std::size_t>(k)] = p - n * (step * static_cast<float>(k));
  std::array<float, steps + 1> d;
  distances(places, d.data());
  bool straight = true;
  for (std::size_t k = 1; k <= steps; ++k) straight &= d[k - 1] - d[k] >= least * step;
  if (straight) return {n, wanted, true};
  // Another face comes near: that of an edge, from which the distance leads away, or the other
  // side.
  Vec3f x = p;
  for (int k = 1; k <= steps; ++k) {
    const Probe at(*this, x, step_);
    const float g2 = length2(at.slope);
    if (g2 < least * least) break;
    x -= at.slope * ((step * static_cast<float>(k) + at.distance) / g2);
  }
  const bool whole = distance(x) < -0.9f * wanted;
  const Vec3f way = p - x;
  const float length = dreampm::length(way);
  if (!(length > 0)) return {n, 0, false};
  return {way / length, whole ? length : share * length, whole};
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
  const std::vector<Vec3i> block = cube(kBlock);
  parallel_for(leaves.size(), 4, [&](std::size_t i) {
    float* const to = values_.data() + i * kValues;
    const Vec3i first = field.leaves[leaves[i]] * SparseField::kWidth - Vec3i{1, 1, 1};
    solids.distances(field.point(first), field.voxel, block, to);
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
    return interpolated((p - field_.origin) / field_.voxel, [&](const Vec3i& leaf) -> LeafValues {
      const std::int32_t l = leaves_.find(leaf);
      if (l == LatticeMap::kAbsent) return {nullptr, 0};
      return l == kInside ? LeafValues{nullptr, 1} : LeafValues{field_.leaf(static_cast<std::size_t>(l)).data(), 0};
    });
  }

 private:
  static constexpr std::int32_t kInside = 1 << 30;
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
    std::vector<Mirrored> mirrored;
    std::vector<Vec3f> opposite;
    for (int i = 0; i < SparseField::kPoints; ++i) {
      const Vec3i at{i & 7, i >> 3 & 7, i >> 6};
      const float* const d = distance + ((at.z + 1) * kB + at.y + 1) * kB + at.x + 1;
      const auto n = static_cast<std::size_t>(i);
      to[i] = own[n];
      if (*d >= 0.99f * solids_.reach()) continue;
      const Vec3f slope = Vec3f{d[1] - d[-1], d[kB] - d[-kB], d[kB * kB] - d[-kB * kB]} / (2 * field_.voxel);
      const float steep = length(slope);
      const Vec3f normal = steep > 0 ? slope / steep : Vec3f{}, p = field_.point(field_.leaves[l] * 8 + at);
      const float sure = std::clamp(4 * steep - 2, 0.0f, 1.0f);  // amid solids the mirror is anyone's guess
      const float mirror = sure > 0 ? value_(p - normal * (2 * *d)) : 0;
      if (*d <= 0) {
        to[i] = std::min(own[n] + sure * mirror, field_.iso + *d / (4 * spacing_));
        continue;
      }
      if (own[n] > 0) to[i] = std::max(own[n], own[n] / std::max(open_.at(p), kLeastOpen));
      if (!(mirror > 0)) continue;
      const float deep = std::max(*d, kLeastDeep * spacing_);
      mirrored.push_back({n, sure, mirror, deep});
      opposite.push_back(p - normal * (*d + deep));
    }
    std::vector<float> beyond(opposite.size());
    solids_.distances(opposite, beyond.data());
    for (std::size_t m = 0; m < mirrored.size(); ++m) {
      const Mirrored& at = mirrored[m];
      // 1 where the mirror image lies as deep in the solid as the point lies before it; 0 where it
      // would lie beyond a thin one.
      const float thick = std::clamp((-beyond[m] / at.deep - 0.25f) * 2, 0.0f, 1.0f);
      to[at.point] = std::max(own[at.point] + at.sure * thick * at.value, to[at.point]);
    }
  }

 private:
  /// A point before a solid that its mirror image may add to.
  struct Mirrored {
    std::size_t point;
    float sure, value, deep;
  };
  static constexpr float kLeastOpen = 0.15f, kLeastDeep = 0.4f;
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
