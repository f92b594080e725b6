// A field on bricks of 8^3 voxels over a box; where nothing happens a brick is one of two
// constants.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/math/four.h"
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
  /// The same at many places, to the same bits: place(axis, number) [voxels].
  template <class InVoxels>
  void samples(std::size_t count, const InVoxels& place, double* to) const;
  /// Returns the direction in which values grow at p [voxels], of length 1; up where they are the
  /// same all around.
  Vec3d direction(const Vec3d& p) const;

 private:
  /// Returns the value in the cell that begins at voxel `i`, at `f` of its sides.
  double sample(const Vec3i& i, const Vec3d& f) const;

  Vec3i low_{}, count_{};
  float band_ = 0;
  std::vector<std::int32_t> slots_;
  std::vector<Values> values_;
};

inline double BrickGrid::sample(const Vec3d& p) const {
  const auto cell = [](double v) { return static_cast<std::int32_t>(std::floor(std::clamp(v, -1e9, 1e9))); };
  const Vec3i i{cell(p.x), cell(p.y), cell(p.z)};
  return sample(i, p - static_cast<Vec3d>(i));
}

inline double BrickGrid::sample(const Vec3i& i, const Vec3d& f) const {
  const Vec3i b{i.x >> 3, i.y >> 3, i.z >> 3};
  // Before and after along z, at the four places along x and y.
  Four<double> before, after;
  if ((i.x & 7) < 7 && (i.y & 7) < 7 && (i.z & 7) < 7) {  // all eight in one brick
    if (!covers(b)) return band_;
    const std::int32_t s = slots_[slot_index(b)];
    if (s < 0) return s == inside ? -band_ : band_;
    const float* q = values_[std::size_t(s)].data() + offset(i.x, i.y, i.z);
    before = Four<double>{q[0], q[8], q[64], q[72]}, after = Four<double>{q[1], q[9], q[65], q[73]};
  } else {
    for (int k = 0; k < 4; ++k) {
      before[k] = at(i.x + (k >> 1), i.y + (k & 1), i.z);
      after[k] = at(i.x + (k >> 1), i.y + (k & 1), i.z + 1);
    }
  }
  const Four<double> z = before + (after - before) * f.z;
  const Two<double> low{z[0], z[2]}, high{z[1], z[3]}, y = low + (high - low) * f.y;
  return y[0] + (y[1] - y[0]) * f.x;
}

template <class InVoxels>
void BrickGrid::samples(std::size_t count, const InVoxels& place, double* to) const {
  constexpr std::size_t at_once = 32;
  std::array<std::array<double, at_once>, 3> cells, parts;
  for (std::size_t begin = 0; begin < count; begin += at_once) {
    const std::size_t some = std::min(at_once, count - begin);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t i = 0; i < some; ++i) {
        const double p = place(a, begin + i), cell = std::floor(std::clamp(p, -1e9, 1e9));
        cells[a][i] = cell, parts[a][i] = p - cell;
      }
    for (std::size_t i = 0; i < some; ++i)
      to[begin + i] = sample(static_cast<Vec3i>(Vec3d{cells[0][i], cells[1][i], cells[2][i]}),
                             {parts[0][i], parts[1][i], parts[2][i]});
  }
}

inline Vec3d BrickGrid::direction(const Vec3d& p) const {
  constexpr double h = 0.5;
  const Vec3d g{sample(p + Vec3d{h, 0, 0}) - sample(p - Vec3d{h, 0, 0}),
                sample(p + Vec3d{0, h, 0}) - sample(p - Vec3d{0, h, 0}),
                sample(p + Vec3d{0, 0, h}) - sample(p - Vec3d{0, 0, h})};
  return length2(g) > 0 ? normalized(g) : Vec3d{0, 1, 0};
}

}  // namespace dreampm
