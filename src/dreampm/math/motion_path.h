// The prescribed motion of a rigid shape: keys over time, or a constant velocity and spin.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "dreampm/model/motion.h"
#include "dreampm/pose.h"

namespace dreampm {

struct MotionPath {
  std::vector<PoseKey> keys;  ///< by time; before the first and after the last the shape stands still
  /// True if the motion comes to rest at every key (smoothstep); false if it is linear between
  /// keys.
  bool smooth = false;
  Vec3d center{};    ///< m, in the shape as the scene gives it: about which it turns
  Vec3d velocity{};  ///< m/s, where there are no keys
  Vec3d spin{};      ///< rad/s, where there are no keys

  bool operator==(const MotionPath&) const = default;

  Pose pose_at(double t) const {
    const Turned at = turned_at(t);
    return {center + at.position - at.rotation(center), at.rotation};
  }
  /// The constant twist that takes the shape from where it is at `from` to where it is at `to` [s],
  /// to > from.
  Twist twist_over(double from, double to) const {
    const Turned a = turned_at(from), b = turned_at(to);
    const double dt = to - from;
    return {(b.position - a.position) / dt, rotation_vector(b.rotation * a.rotation.inverse()) / dt,
            center + a.position};
  }
  /// The largest speed of the center [m/s] and spin [rad/s] within [from, to].
  struct Fastest {
    double speed = 0, spin = 0;
  };
  Fastest fastest_within(double from, double to) const {
    if (keys.empty()) return {length(velocity), length(spin)};
    Fastest all;
    // Smoothstep is 1.5 times as fast in its middle as in the mean.
    const double peak = smooth ? 1.5 : 1;
    for (std::size_t i = 1; i < keys.size(); ++i) {
      const PoseKey &a = keys[i - 1], &b = keys[i];
      if (b.t < from || a.t > to) continue;
      all.speed = std::max(all.speed, peak * length(b.position - a.position) / (b.t - a.t));
      all.spin = std::max(all.spin, peak * angle_between(a, b) / (b.t - a.t));
    }
    return all;
  }

  /// The vector of a rotation by at most half a turn.
  static Vec3d rotation_vector(const Quaternion& q) {
    const Vec3d axis = Vec3d{q.x, q.y, q.z} * (q.w < 0 ? -1.0 : 1.0);
    const double sine = length(axis);
    return sine > 0 ? axis * (2 * std::atan2(sine, std::abs(q.w)) / sine) : Vec3d{};
  }

 private:
  struct Turned {
    Vec3d position;
    Quaternion rotation;
  };
  static constexpr double degree = std::numbers::pi / 180;

  static Quaternion rotation_of(const PoseKey& k) {
    return Quaternion::about(normalized(k.rotate_axis) * (k.rotate_angle * degree));
  }
  /// True if both keys turn about one axis: the angle between them may be several turns; else it is
  /// the shortest.
  static bool one_axis(const PoseKey& a, const PoseKey& b) {
    return a.rotate_angle == 0 || b.rotate_angle == 0 || normalized(a.rotate_axis) == normalized(b.rotate_axis);
  }
  static double angle_between(const PoseKey& a, const PoseKey& b) {
    return one_axis(a, b) ? std::abs(b.rotate_angle - a.rotate_angle) * degree
                          : length(rotation_vector(rotation_of(b) * rotation_of(a).inverse()));
  }
  static Quaternion between(const PoseKey& a, const PoseKey& b, double s) {
    if (one_axis(a, b)) {
      const Vec3d& axis = a.rotate_angle == 0 ? b.rotate_axis : a.rotate_axis;
      return Quaternion::about(normalized(axis) * ((a.rotate_angle * (1 - s) + b.rotate_angle * s) * degree));
    }
    return Quaternion::about(rotation_vector(rotation_of(b) * rotation_of(a).inverse()) * s) * rotation_of(a);
  }
  Turned turned_at(double t) const {
    if (keys.empty()) return {velocity * t, Quaternion::about(spin * t)};
    if (t <= keys.front().t) return {keys.front().position, rotation_of(keys.front())};
    for (std::size_t i = 1; i < keys.size(); ++i)
      if (t < keys[i].t) {
        const PoseKey &a = keys[i - 1], &b = keys[i];
        double s = (t - a.t) / (b.t - a.t);
        if (smooth) s = s * s * (3 - 2 * s);
        return {a.position * (1 - s) + b.position * s, between(a, b, s)};
      }
    return {keys.back().position, rotation_of(keys.back())};
  }
};

}  // namespace dreampm
