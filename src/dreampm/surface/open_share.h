// The share of a kernel that no solid takes.
#pragma once
#include <vector>

#include "dreampm/surface/lattice.h"
#include "dreampm/surface/solids.h"

namespace dreampm::surface {

/// 1 far from solids, 1/2 at a flat one, less in corners: the open part of space, averaged with the
/// variance of a kernel of that support. Kept on bricks of a lattice of one spacing.
class OpenShare {
 public:
  /// For points within the boxes.
  OpenShare(const Solids& solids, const std::vector<Box3f>& boxes, float spacing, float support);

  /// By linear interpolation; 1 beyond the boxes.
  float at(const Vec3f& p) const;

 private:
  static constexpr int kW = 8, kPoints = kW * kW * kW, kTaps = 4;
  using Brick = std::array<float, kPoints>;

  /// Averages around the points of a brick, from what is open around it.
  void average(const Vec3i& brick, Brick& to) const;

  float spacing_;
  std::array<float, kTaps + 1> taps_{};
  LatticeMap open_index_, index_;
  std::vector<Brick> open_, bricks_;
};

}  // namespace dreampm::surface
