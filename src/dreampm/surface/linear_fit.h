// A linear velocity field through particles, by weighted least squares.
#pragma once
#include "dreampm/math/mat3.h"

namespace dreampm::surface {

/// v(x) = mean_v + slope (x - mean_x). Places count from where the particles are gathered.
class LinearFit {
 public:
  explicit LinearFit(float radius) : radius_(radius) {}
  /// A particle at `d` from the middle counts by (1 - d^2 / radius^2)^3.
  void add(const Vec3f& d, const Vec3f& velocity) {
    const float t = 1 - length2(d) / (radius_ * radius_);
    if (t <= 0) return;
    const float w = t * t * t;
    sum_ += w;
    mean_x_ += w * d, mean_v_ += w * velocity;
    xx_ = xx_ + outer(d, d) * w, vx_ = vx_ + outer(velocity, d) * w;
  }
  bool empty() const { return sum_ <= 0; }
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
    const Vec3f mean_x = mean_x_ / sum_, mean_v = mean_v_ / sum_;
    const Mat3f cov = xx_ * (1 / sum_) - outer(mean_x, mean_x), cross_cov = vx_ * (1 / sum_) - outer(mean_v, mean_x);
    const float few = 0.001f * radius_ * radius_;
    const Mat3f solid = cov + Mat3f::diagonal(few, few, few);
    return {mean_x, mean_v, cross_cov * (transpose(cofactor(solid)) * (1 / determinant(solid)))};
  }
  float radius_, sum_ = 0;
  Vec3f mean_x_{}, mean_v_{};
  Mat3f xx_, vx_;
};

}  // namespace dreampm::surface
