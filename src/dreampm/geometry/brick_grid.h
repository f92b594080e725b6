// A field on bricks of 8^3 voxels over a box; where nothing happens a brick is one of two
// constants.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/math/vec.h"

namespace dreampm {

/// Values sit at integer points; brick b covers [8b, 8b + 7]. Lengths are in voxels, negative
/// inside.
class BrickGrid {
 public:
  static constexpr std::int32_t outside = -1, inside = -2;
  static constexpr int side = 8, volume = 512;
  using Values = std::array<float, volume>;

  BrickGrid() = default;
  /// Bricks `low` to `high`, both included, all outside. |values| are at most `band` voxels.
  BrickGrid(Vec3i low, Vec3i high, float band)
      : low_(low),
        count_(high - low + Vec3i{1, 1, 1}),
        band_(band),
        slots_(std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z), outside) {}

  float band() const { return band_; }
  std::size_t size() const { return slots_.size(); }
  bool covers(const Vec3i& b) const {
    const Vec3i r = b - low_;
    return r.x >= 0 && r.y >= 0 && r.z >= 0 && r.x < count_.x && r.y < count_.y && r.z < count_.z;
  }
  /// Brick coordinates of the i-th slot and back (z fastest).
  Vec3i brick(std::size_t i) const {
    const auto k = static_cast<std::int32_t>(i % std::size_t(count_.z));
    i /= std::size_t(count_.z);
    return low_ + Vec3i{static_cast<std::int32_t>(i / std::size_t(count_.y)),
                        static_cast<std::int32_t>(i % std::size_t(count_.y)), k};
  }
  std::size_t slot_index(const Vec3i& b) const {
    const Vec3i r = b - low_;
    return (std::size_t(r.x) * std::size_t(count_.y) + std::size_t(r.y)) * std::size_t(count_.z) + std::size_t(r.z);
  }
  /// outside, inside, or an index into values().
  std::int32_t& slot(std::size_t i) { return slots_[i]; }
  std::int32_t slot(std::size_t i) const { return slots_[i]; }
  std::vector<Values>& values() { return values_; }
  const std::vector<Values>& values() const { return values_; }
  /// Gives the i-th slot its own values, all `fill`; not for two threads at once.
  Values& open(std::size_t i, float fill) {
    slots_[i] = static_cast<std::int32_t>(values_.size());
    values_.emplace_back().fill(fill);
    return values_.back();
  }
  static constexpr std::size_t offset(int x, int y, int z) {
    return std::size_t((x & 7) << 6 | (y & 7) << 3 | (z & 7));
  }

  /// The value at a voxel; band() beyond the box.
  float at(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const Vec3i b{x >> 3, y >> 3, z >> 3};
    if (!covers(b)) return band_;
    const std::int32_t s = slots_[slot_index(b)];
    return s >= 0 ? values_[std::size_t(s)][offset(x, y, z)] : s == inside ? -band_ : band_;
  }
  /// Trilinear between voxels, at p [voxels].
  double sample(const Vec3d& p) const;
  /// Where the values grow at p [voxels], of length 1; up where they are the same all about.
  Vec3d direction(const Vec3d& p) const;

 private:
  Vec3i low_{}, count_{};
  float band_ = 0;
  std::vector<std::int32_t> slots_;
  std::vector<Values> values_;
};

inline double BrickGrid::sample(const Vec3d& p) const {
  const auto cell = [](double v) { return static_cast<std::int32_t>(std::floor(std::clamp(v, -1e9, 1e9))); };
  const Vec3i i{cell(p.x), cell(p.y), cell(p.z)};
  double v[8];
  const Vec3i b{i.x >> 3, i.y >> 3, i.z >> 3};
  if ((i.x & 7) < 7 && (i.y & 7) < 7 && (i.z & 7) < 7) {  // all eight in one brick
    if (!covers(b)) return band_;
    const std::int32_t s = slots_[slot_index(b)];
    if (s < 0) return s == inside ? -band_ : band_;
    const float* q = values_[std::size_t(s)].data() + offset(i.x, i.y, i.z);
    v[0] = q[0], v[1] = q[1], v[2] = q[8], v[3] = q[9], v[4] = q[64], v[5] = q[65], v[6] = q[72], v[7] = q[73];
  } else {
    for (int k = 0; k < 8; ++k) v[k] = at(i.x + (k >> 2), i.y + (k >> 1 & 1), i.z + (k & 1));
  }
  const Vec3d f = p - static_cast<Vec3d>(i);
  const auto mix = [](double a, double c, double t) { return a + (c - a) * t; };
  return mix(mix(mix(v[0], v[1], f.z), mix(v[2], v[3], f.z), f.y), mix(mix(v[4], v[5], f.z), mix(v[6], v[7], f.z), f.y),
             f.x);
}

inline Vec3d BrickGrid::direction(const Vec3d& p) const {
  constexpr double h = 0.5;
  const Vec3d g{sample(p + Vec3d{h, 0, 0}) - sample(p - Vec3d{h, 0, 0}),
                sample(p + Vec3d{0, h, 0}) - sample(p - Vec3d{0, h, 0}),
                sample(p + Vec3d{0, 0, h}) - sample(p - Vec3d{0, 0, h})};
  return length2(g) > 0 ? normalized(g) : Vec3d{0, 1, 0};
}

}  // namespace dreampm
