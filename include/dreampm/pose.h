// Pose and twist: the place of a rigid shape, and how it moves.
#pragma once
#include <cmath>

#include "dreampm/vec.h"

namespace dreampm {

/// A rotation, as a unit quaternion.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;

  /// The rotation about the axis of `turn`, by its length [rad], right-handed.
  static Quaternion about(const Vec3d& turn) {
    const double angle = length(turn);
    if (!(angle > 0)) return {};
    const Vec3d axis = turn * (std::sin(0.5 * angle) / angle);
    return {std::cos(0.5 * angle), axis.x, axis.y, axis.z};
  }
  Quaternion inverse() const { return {w, -x, -y, -z}; }
  Quaternion normalized() const {
    const double size = std::sqrt(w * w + x * x + y * y + z * z);
    return {w / size, x / size, y / size, z / size};
  }
  Vec3d operator()(const Vec3d& v) const {
    const Vec3d axis{x, y, z}, across = cross(axis, v) * 2.0;
    return v + across * w + cross(axis, across);
  }
  /// The rotation `b`, and then this one.
  friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  }
  bool operator==(const Quaternion&) const = default;
};

/// Takes the point p of a shape, as the scene gives it, to position + rotation(p).
struct Pose {
  Vec3d position{};  ///< m
  Quaternion rotation{};

  Vec3d operator()(const Vec3d& p) const { return position + rotation(p); }
  Vec3d inverse(const Vec3d& p) const { return rotation.inverse()(p - position); }
  bool operator==(const Pose&) const = default;
};

/// The motion of a rigid shape: its point x moves at velocity + spin x (x - center).
struct Twist {
  Vec3d velocity{};  ///< m/s, of the center
  Vec3d spin{};      ///< rad/s
  Vec3d center{};    ///< m, which moves along

  Vec3d at(const Vec3d& p) const { return velocity + cross(spin, p - center); }
  bool at_rest() const { return velocity == Vec3d{} && spin == Vec3d{}; }
  bool operator==(const Twist&) const = default;
};

}  // namespace dreampm
