// A rigid obstacle: a shape, where it stands, how it moves, and what its surface does to matter.
#pragma once
#include <limits>
#include <memory>
#include <string>

#include "dreampm/geometry/region.h"
#include "dreampm/math/motion_path.h"
#include "dreampm/physics/contact.h"
#include "dreampm/pose.h"

namespace dreampm {

/// Positions in metres of the scene.
struct Collider {
  /// Cells that a surface may be off the pose of its collider.
  static constexpr double settle_distance = 0.02;

  std::string name;
  std::shared_ptr<const Region> shape;  ///< as the scene gives it
  WallType type = WallType::separate;
  double friction = 0;
  double sticky = 0;  ///< Pa: the tension that it holds matter with, of one that matter may separate from
  /// Whether matter that starts inside is held there, as if clamped. Such a collider puts no
  /// particle back out of it.
  bool holds = false;
  Pose pose{};    ///< of the shape
  Twist twist{};  ///< of the step to come
  /// Where the solver looks for its surface: at the pose, or up to `settle_distance` off. What is
  /// known of the surface is found anew where this changes.
  Pose surface_pose{};
  /// Where it is to stand at each time, if that is prescribed; pose and twist follow it.
  std::shared_ptr<const MotionPath> path{};
  bool rigid = false;  ///< whether it is a rigid body (state/rigid_body.h)

  /// What its surface does to matter: what it holds moves with it.
  WallType contact() const { return holds ? WallType::stick : type; }
  /// Whether it may stand elsewhere than in the scene.
  bool moves() const { return rigid || path || !twist.at_rest() || !(pose == Pose{}); }
  /// Moves on for `dt` [s].
  void advance(double dt);
  /// Follows its path, if it has one, in a step from `time` to time + dt [s].
  void follow(double time, double dt);
  /// Brings the surface to the pose where some point of it is off by more than `tolerance` [m].
  void settle(double tolerance);

  /// Signed distance [m] from its surface, negative inside.
  double distance(const Vec3d& p) const {
    return moves() ? shape->distance(surface_pose.inverse(p)) : shape->distance(p);
  }
  /// The outward unit normal there.
  Vec3d normal(const Vec3d& p) const {
    return moves() ? surface_pose.rotation(shape->normal(surface_pose.inverse(p))) : shape->normal(p);
  }
  /// A box that holds it [m]; infinite where the shape is and is not turned along an axis.
  Box3d bounds() const;
  /// The largest speed [m/s] of its points within `domain`, a finite box, from `time` to time +
  /// ahead [s].
  double fastest(const Box3d& domain, double time, double ahead) const;
};

}  // namespace dreampm
