// Changes over time in a scene: keys, and motions of shapes.
#pragma once
#include <optional>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

/// A value at a time. Between keys values change linearly, before the first and after the last they
/// are constant. T: anything with + and * by a double.
template <class T>
struct Key {
  double t = 0;  ///< s
  T value{};
  friend bool operator==(const Key&, const Key&) = default;
};

/// The pose of a shape at a time: moved by `position` from its place in the scene, and turned about
/// one of its points.
struct PoseKey {
  double t = 0;                ///< s
  Vec3d position{};            ///< m
  Vec3d rotate_axis{0, 1, 0};  ///< need not have unit length
  double rotate_angle = 0;     ///< degrees
  bool operator==(const PoseKey&) const = default;
};

namespace model {

/// The motion of a shape: by keys, or at a constant velocity and spin.
struct Motion {
  std::vector<PoseKey> keys;   ///< by time
  bool smooth = false;         ///< with keys: it slows down at each; else straight from key to key
  Vec3d velocity{};            ///< m/s, without keys
  Vec3d spin{};                ///< rad/s, without keys
  std::optional<Vec3d> about;  ///< m: the point of the shape that it turns about; absent: its middle
};

}  // namespace model
}  // namespace dreampm
