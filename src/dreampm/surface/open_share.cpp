#include "dreampm/surface/open_share.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"

namespace dreampm::surface {
namespace {

constexpr int kBrick = 8;

Vec3i brick_of(const Vec3i& p) { return {p.x >> 3, p.y >> 3, p.z >> 3}; }

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
    wanted.add(brick_of(lattice_cell(b.min, spacing)), brick_of(lattice_cell(b.max, spacing) + Vec3i{1, 1, 1}));
  const std::vector<Vec3i> bricks = wanted.take(index_);
  BrickList around;
  for (const Vec3i& b : bricks) around.add(b - Vec3i{1, 1, 1}, b + Vec3i{1, 1, 1});
  const std::vector<Vec3i> open = around.take(open_index_);
  open_.resize(open.size());
  parallel_for(open.size(), 4, [&](std::size_t i) {
    solids.distances(Vec3f(open[i] * kBrick) * spacing, spacing, kBrick, open_[i].data());
    for (float& v : open_[i]) v = std::clamp(0.5f + v / spacing, 0.0f, 1.0f);
  });
  bricks_.resize(bricks.size());
  parallel_for(bricks.size(), 4, [&](std::size_t i) { average(bricks[i], bricks_[i]); });
  open_ = {};
}

void OpenShare::average(const Vec3i& brick, Brick& to) const {
  constexpr int wide = kW + 2 * kTaps;
  static_assert(kTaps <= kW);
  const auto in_brick = [](const Vec3i& p) {
    return static_cast<std::size_t>(((p.z & 7) * kW + (p.y & 7)) * kW + (p.x & 7));
  };
  std::vector<float> a(wide * wide * wide), b(wide * wide * kW), c(wide * kW * kW);
  const Vec3i first = brick * kW - Vec3i{kTaps, kTaps, kTaps};
  std::size_t n = 0;
  for (int z = 0; z < wide; ++z)
    for (int y = 0; y < wide; ++y)
      for (int x = 0; x < wide; ++x) {
        const Vec3i p = first + Vec3i{x, y, z};
        a[n++] = open_[static_cast<std::size_t>(open_index_.find(brick_of(p)))][in_brick(p)];
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

float OpenShare::value(const Vec3i& p) const {
  const std::int32_t i = index_.find(brick_of(p));
  if (i == LatticeMap::kAbsent) return 1;
  return bricks_[static_cast<std::size_t>(i)][static_cast<std::size_t>(((p.z & 7) * kW + (p.y & 7)) * kW + (p.x & 7))];
}

float OpenShare::at(const Vec3f& p) const {
  const Vec3f u = p / spacing_;
  const Vec3i i = lattice_cell(u, 1);
  const Vec3f f = u - Vec3f(i);
  float sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3i o{c & 1, c >> 1 & 1, c >> 2 & 1};
    const float w = (o.x ? f.x : 1 - f.x) * (o.y ? f.y : 1 - f.y) * (o.z ? f.z : 1 - f.z);
    sum += w * value(i + o);
  }
  return sum;
}

}  // namespace dreampm::surface
