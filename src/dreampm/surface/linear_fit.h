// A linear velocity field through particles, by weighted least squares.
#pragma once
#include "dreampm/math/mat3.h"
#include "dreampm/surface/wide.h"

namespace dreampm::surface {

/// v(x) = mean_v + slope (x - mean_x). Places count from where the particles are gathered.
class LinearFit {
 public:
  explicit LinearFit(float radius) : radius_(radius) {}
  /// A particle at `d` from the middle counts by (1 - d^2 / radius^2)^3.
  void add(const Vec3f& d, const Vec3f& velocity) {
    const float t = 1 - length2(d) / (radius_ * radius_);
    if (t > 0) add_lanes(Wide{1, d.x, d.y, d.z, velocity.x, velocity.y, velocity.z, 0}, t);
  }
  /// The same of a particle whose 1 - d^2 / radius^2 is `t`, above 0. `p`: 1, its offset d, its
  /// velocity, 0.
  [[gnu::always_inline]] inline void add_lanes(const Wide& p, float t) {
    const float w = t * t * t;
    sums_ += w * p;
    xx_ += __builtin_shufflevector(p, p, 1, 1, 1, 2, 2, 3, 4, 4) *
           __builtin_shufflevector(p, p, 1, 2, 3, 2, 3, 3, 1, 2) * w;
    vx_ += __builtin_shufflevector(p, p, 4, 5, 5, 5, 6, 6, 6, 7) *
           __builtin_shufflevector(p, p, 3, 1, 2, 3, 1, 2, 3, 7) * w;
  }
  bool empty() const { return sums_[0] <= 0; }
  /// In the middle, from where places count.
  Vec3f velocity() const {
    const Solved s = solved();
    return s.mean_v - s.slope * s.mean_x;
  }
  Mat3f slope() const { return solved().slope; }

 private:
  struct Solved {
    Vec3f mean_x, mean_v;
    Mat3f slope;
  };
  /// Slope = cov(v, x) cov(x, x)^-1; the small diagonal keeps it finite and fades it out where
  /// points are few.
  Solved solved() const {
    const Wide &s = sums_, &a = xx_, &b = vx_;
    const Mat3f xx{{a[0], a[1], a[2], a[1], a[3], a[4], a[2], a[4], a[5]}};
    const Mat3f vx{{a[6], a[7], b[0], b[1], b[2], b[3], b[4], b[5], b[6]}};
    const Vec3f mean_x = Vec3f{s[1], s[2], s[3]} / s[0], mean_v = Vec3f{s[4], s[5], s[6]} / s[0];
    const Mat3f cov = xx * (1 / s[0]) - outer(mean_x, mean_x), cross_cov = vx * (1 / s[0]) - outer(mean_v, mean_x);
    const float few = 0.001f * radius_ * radius_;
    const Mat3f solid = cov + Mat3f::diagonal(few, few, few);
    return {mean_x, mean_v, cross_cov * (transpose(cofactor(solid)) * (1 / determinant(solid)))};
  }
  float radius_;
  Wide sums_{};  ///< of w (1, d, v)
  Wide xx_{};    ///< of w d d^T, its upper half, and of the first two numbers of w v d^T
  Wide vx_{};    ///< of its other seven
};

}  // namespace dreampm::surface
