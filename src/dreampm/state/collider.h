// A rigid obstacle: a shape, where it stands, how it moves, and what its surface does to matter.
#pragma once
#include <limits>
#include <memory>
#include <string>

#include "dreampm/geometry/changing_region.h"
#include "dreampm/math/motion_path.h"
#include "dreampm/physics/contact.h"
#include "dreampm/pose.h"

namespace dreampm {

/// Positions in meters of the scene.
struct Collider {
  /// Cells that a surface may be off the pose of its collider, where that does not say otherwise.
  static constexpr double settle_distance = 0.02;

  std::string name;
  std::shared_ptr<const Region> shape;  ///< as the scene gives it
  WallType type = WallType::separate;
  double friction = 0;
  double sticky = 0;  ///< Pa: the tension that it holds matter with, of one that matter may separate from
  /// True if matter that starts inside is held there, as if clamped. Such a collider puts no
  /// particle back out of it.
  bool holds = false;
  Pose pose{};    ///< of the shape
  Twist twist{};  ///< of the step to come
  /// The pose at which the solver looks for the surface: the pose itself, or one up to `slack` off.
  /// Caches of the surface are made anew where this changes.
  Pose surface_pose{};
  /// The prescribed motion, if there is one; pose and twist follow it.
  std::shared_ptr<const MotionPath> path{};
  bool rigid = false;  ///< true if it is a rigid body (state/rigid_body.h)
  /// The region of a collider whose surface changes. `shape` is its state at `surface_time` [s],
  /// which is `time`, or an earlier time since which no point moved by more than `settle_distance`.
  std::shared_ptr<const ChangingRegion> changing{};
  double time = 0, surface_time = 0;
  /// Cells that its surface may be off its pose: with more, one that moves costs less.
  double slack = settle_distance;

  /// The effect of the surface on matter: matter that the collider holds moves with it.
  WallType contact() const { return holds ? WallType::stick : type; }
  /// True if its pose may differ from the scene's.
  bool moves() const { return rigid || path || changing || !twist.at_rest() || !(pose == Pose{}); }
  /// True if its surface is at rest.
  bool stands() const { return !rigid && !changing && twist.at_rest(); }
  /// Moves on for `dt` [s].
  void advance(double dt);
  /// Follows its path, or changes, if it does, in a step from `from` to from + dt [s].
  void follow(double from, double dt);
  /// Brings the surface to the pose, and the time, where some point of it is off by more than
  /// `tolerance` [m].
  void settle(double tolerance);
  /// Makes its shape that of `surface_time`.
  void take_shape() {
    if (changing) shape = changing->at(surface_time);
  }

  /// Signed distance [m] from its surface, negative inside.
  double distance(const Vec3d& p) const {
    return moves() ? shape->distance(surface_pose.inverse(p)) : shape->distance(p);
  }
  /// The velocity of its surface, or of its matter, there [m/s].
  Vec3d velocity(const Vec3d& p) const { return changing ? twist.at(p) + changing->velocity(p, time) : twist.at(p); }
  /// The outward unit normal there.
  Vec3d normal(const Vec3d& p) const {
    return moves() ? surface_pose.rotation(shape->normal(surface_pose.inverse(p))) : shape->normal(p);
  }
  /// A box that holds it [m]; infinite where the shape is and is not turned along an axis.
  Box3d bounds() const;
  /// The largest speed [m/s] of its points within `domain`, a finite box, from `from` to from +
  /// ahead [s].
  double fastest(const Box3d& domain, double from, double ahead) const;
};

}  // namespace dreampm
