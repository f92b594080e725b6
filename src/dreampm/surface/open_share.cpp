#include "dreampm/surface/open_share.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
#include "dreampm/surface/leaf_values.h"

namespace dreampm::surface {
namespace {

/// Finds what is open of a brick of 8^3 cells. Most are wholly open or wholly taken, as one
/// distance shows for each 2^3 of them: others are asked for one by one.
class OpenCells {
 public:
  OpenCells(const Solids& solids, float spacing) : solids_(solids), spacing_(spacing) {}
  void find(const Vec3i& brick, float* to) const {
    const Vec3f first = Vec3f(brick * 8) * spacing_, half{0.5f * spacing_, 0.5f * spacing_, 0.5f * spacing_};
    std::array<float, 64> middle;
    solids_.distances(first + half, 2 * spacing_, blocks_, middle.data());
    std::vector<Vec3i> unsure;
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      for (const Vec3i& o : eight_) {
        const Vec3i p = blocks_[b] * 2 + o;
        if (std::abs(middle[b]) < kEnough * spacing_)
          unsure.push_back(p);
        else
          to[place_in_leaf(p)] = middle[b] > 0 ? 1.0f : 0.0f;
      }
    std::vector<float> d(unsure.size());
    solids_.distances(first, spacing_, unsure, d.data());
    for (std::size_t i = 0; i < unsure.size(); ++i)
      to[place_in_leaf(unsure[i])] = std::clamp(0.5f + d[i] / spacing_, 0.0f, 1.0f);
  }

 private:
  static constexpr float kEnough = 1.5f;  // half a cell, and from the middle of 2^3 to the farthest
  const Solids& solids_;
  float spacing_;
  std::vector<Vec3i> blocks_ = cube(4), eight_ = cube(2);
};

/// The bricks from one to another, both included, once each and in order.
class BrickList {
 public:
  void add(const Vec3i& low, const Vec3i& high) {
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) keys_.push_back(LatticeMap::key({x, y, z}));
  }
  std::vector<Vec3i> take(LatticeMap& index) {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    index = LatticeMap(keys_.size());
    std::vector<Vec3i> bricks;
    for (const std::uint64_t key : keys_) {
      index.insert(LatticeMap::place(key), static_cast<std::int32_t>(bricks.size()));
      bricks.push_back(LatticeMap::place(key));
    }
    return bricks;
  }

 private:
  std::vector<std::uint64_t> keys_;
};

}  // namespace

OpenShare::OpenShare(const Solids& solids, const std::vector<Box3f>& boxes, float spacing, float support)
    : spacing_(spacing) {
  // A Gaussian of the kernel's variance, support^2 / 11, less that of what is averaged already.
  const float variance = support * support / (11 * spacing * spacing) - 1.0f / 12;
  float sum = 0;
  for (int k = 0; k <= kTaps; ++k) {
    taps_[static_cast<std::size_t>(k)] = std::exp(-static_cast<float>(k * k) / (2 * variance));
    sum += (k == 0 ? 1 : 2) * taps_[static_cast<std::size_t>(k)];
  }
  for (float& t : taps_) t /= sum;

  BrickList wanted;
  for (const Box3f& b : boxes)
    wanted.add(leaf_of(lattice_cell(b.min, spacing)), leaf_of(lattice_cell(b.max, spacing) + Vec3i{1, 1, 1}));
  const std::vector<Vec3i> bricks = wanted.take(index_);
  BrickList around;
  for (const Vec3i& b : bricks) around.add(b - Vec3i{1, 1, 1}, b + Vec3i{1, 1, 1});
  const std::vector<Vec3i> open = around.take(open_index_);
  open_.resize(open.size());
  const OpenCells cells(solids, spacing);
  parallel_for(open.size(), 4, [&](std::size_t i) { cells.find(open[i], open_[i].data()); });
  bricks_.resize(bricks.size());
  parallel_for(bricks.size(), 4, [&](std::size_t i) { average(bricks[i], bricks_[i]); });
  open_ = {};
}

void OpenShare::average(const Vec3i& brick, Brick& to) const {
  constexpr int wide = kW + 2 * kTaps;
  static_assert(kTaps <= kW);
  std::vector<float> a(wide * wide * wide), b(wide * wide * kW), c(wide * kW * kW);
  const Vec3i first = brick * kW - Vec3i{kTaps, kTaps, kTaps};
  std::size_t n = 0;
  for (int z = 0; z < wide; ++z)
    for (int y = 0; y < wide; ++y) {
      const float* row = nullptr;  // of a brick, from x = 0 in it
      for (int x = 0; x < wide; ++x) {
        const Vec3i p = first + Vec3i{x, y, z};
        if (row == nullptr || (p.x & 7) == 0)
          row = open_[static_cast<std::size_t>(open_index_.find(leaf_of(p)))].data() + place_in_leaf({0, p.y, p.z});
        a[n++] = row[p.x & 7];
      }
    }
  // One axis after the other; `stride` is that of the axis in `from`.
  const auto pass = [&](const float* from, std::size_t stride) {
    float sum = taps_[0] * from[kTaps * stride];
    for (std::size_t k = 1; k <= kTaps; ++k)
      sum += taps_[k] * (from[(kTaps - k) * stride] + from[(kTaps + k) * stride]);
    return sum;
  };
  n = 0;
  for (std::size_t zy = 0; zy < wide * wide; ++zy)
    for (std::size_t x = 0; x < kW; ++x) b[n++] = pass(&a[zy * wide + x], 1);
  n = 0;
  for (std::size_t z = 0; z < wide; ++z)
    for (std::size_t yx = 0; yx < kW * kW; ++yx) c[n++] = pass(&b[z * wide * kW + yx], kW);
  for (std::size_t zyx = 0; zyx < kPoints; ++zyx) to[zyx] = pass(&c[zyx], kW * kW);
}

float OpenShare::at(const Vec3f& p) const {
  return interpolated(p / spacing_, [&](const Vec3i& brick) -> LeafValues {
    const std::int32_t i = index_.find(brick);
    return {i == LatticeMap::kAbsent ? nullptr : bricks_[static_cast<std::size_t>(i)].data(), 1};
  });
}

}  // namespace dreampm::surface
