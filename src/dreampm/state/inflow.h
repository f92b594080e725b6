// Emitters and sinks, as the state of a World.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dreampm/geometry/region.h"
#include "dreampm/math/keyframes.h"
#include "dreampm/math/motion_path.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// A shape that stays filled with matter which moves through it in one direction: particles come in
/// at places of blue noise that moves along, where they enter the shape. What is said of places and
/// directions is in the frame of the shape, which may move.
struct Emitter {
  std::string name;
  std::shared_ptr<const Region> shape;  ///< as the scene gives it
  std::size_t set = 0;                  ///< of the world, that it gives to
  Vec3d along{0, -1, 0};                ///< unit vector
  std::vector<Key<double>> speed;       ///< m/s, at least one key, none below 0
  double swirl = 0;                     ///< rad/s about `along` through the middle of the shape
  double jitter = 0;                    ///< spacings that particles are off these places along each axis at most
  double start = 0;                     ///< s
  double stop = std::numeric_limits<double>::infinity();  ///< s
  /// Particles that it may give in all, or, where it recycles, that its set may hold.
  std::uint64_t pool = 0;
  bool recycle = false;
  std::uint64_t born = 0;                    ///< particles that it gave so far
  bool dry = false;                          ///< true if its pool was ever used up
  std::shared_ptr<const MotionPath> path{};  ///< motion of the shape; null: it stays at the scene's place
  std::optional<Vec3d> color{};              ///< sRGB, of what it gives; decides nothing

  bool gives_within(double from, double to) const { return start <= to && stop >= from; }
  double speed_at(double time) const { return value_at(std::span<const Key<double>>(speed), time); }
  Pose pose_at(double time) const { return path ? path->pose_at(time) : Pose{}; }
  /// Returns the motion of the shape at that time.
  Twist twist_at(double time) const {
    constexpr double moment = 1e-6;  // s
    return path ? path->twist_over(time, time + moment) : Twist{};
  }
  /// The largest speed of what comes in from `from` to `to` [s], swirl and motion included [m/s].
  double fastest(double from, double to) const {
    double v = std::max(speed_at(from), speed_at(to));
    for (const Key<double>& k : speed)
      if (k.t > from && k.t < to) v = std::max(v, k.value);
    const Box3d own = shape->bounds();
    const double inside = std::hypot(v, swirl * 0.5 * length(own.size()));
    if (!path) return inside;
    const MotionPath::Fastest most = path->fastest_within(from, to);
    return inside + most.speed + most.spin * (length(own.center() - path->center) + 0.5 * length(own.size()));
  }
  /// Returns the distance that its places have moved since the start [m].
  double moved(double time) const {
    return time > start ? mean_over(std::span<const Key<double>>(speed), start, time) * (time - start) : 0;
  }
};

/// A batch of matter that an emitter gave: particles of the ids first_id to first_id + count - 1.
struct Arrival {
  std::uint32_t first_id = 0, count = 0;
  std::uint32_t emitter = 0;  ///< its number in World::emitters
  double time = 0;            ///< s, when they came in
  bool operator==(const Arrival&) const = default;
};

/// A sink. It takes out matter inside it when particles are sorted: every few steps.
struct Sink {
  std::string name;
  std::shared_ptr<const Region> shape;       ///< region of the sink; null for a collider
  std::optional<std::size_t> collider = {};  ///< collider that takes matter within a cell of it
  std::uint64_t taken = 0;                   ///< number of particles taken so far
  Vec3d momentum{};                          ///< kg m/s, of the particles taken
  Vec3d angular{};                           ///< kg m^2/s, of the particles taken, about the scene's origin
  std::shared_ptr<const MotionPath> path{};  ///< motion of the shape; null: it stays at the scene's place
};

}  // namespace dreampm
