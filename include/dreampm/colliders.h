// Colliders and rigid bodies of a simulation: what is added, where they stand, and their shapes.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "dreampm/model/colliders.h"
#include "dreampm/pose.h"
#include "dreampm/vec.h"

namespace dreampm {

/// A point of a rigid body that is drawn to a point that stands, by a damped spring. It is
/// implicit: no stiffness makes a step too long.
struct SpringAnchor {
  /// m, of the shape as the scene gives it: `collider(name).pose.inverse(p)` of a point p of the
  /// body as it stands.
  Vec3d at;
  Vec3d to;              ///< m
  double stiffness = 0;  ///< N/m, above 0
  double damping = 0;    ///< N s/m, at least 0
};

/// A collider or rigid body at some time.
struct ColliderState {
  Pose pose;        ///< of its shape, as the scene gives it
  Twist twist;      ///< of the step to come
  double mass = 0;  ///< kg, of a rigid body; 0 of other colliders
  /// N: what matter pressed it with, on average over the steps of the last call that took any; 0
  /// after `restore`, and after colliders came or went.
  Vec3d force{};
  WallType type = WallType::separate;  ///< effect of its surface on matter
  double friction = 0;                 ///< Coulomb's coefficient
  double restitution = 0;              ///< of impacts, 0 to 1, of a rigid body; 0 of other colliders
  double surface_tolerance = 0;        ///< cells, as `set_surface_tolerance` has them
  bool is_rigid = false;               ///< true if it is a rigid body
  bool moves = false;                  ///< true if it may stand elsewhere than in the scene
  bool deforms = false;                ///< true if its shape changes
};

/// The shape of a collider or rigid body where the solver has its surface, which is up to
/// `surface_tolerance` cells off its pose. Stays as it was when it was asked for. Cheap to copy,
/// safe to share between threads. Of use only where a Simulation gave it.
class ColliderShape {
 public:
  const std::string& name() const;
  double mass() const;                        ///< kg, of a rigid body; 0 of other colliders
  bool is_rigid() const;                      ///< true if it is a rigid body
  double distance(const Vec3d& point) const;  ///< m, from its surface; negative inside
  Vec3d normal(const Vec3d& point) const;     ///< outward, of length 1
  Vec3d velocity(const Vec3d& point) const;   ///< m/s, of its surface there
  /// m: a box that holds it as it stands; infinite where the shape is, and is not turned along an
  /// axis.
  Box3d bounds() const;
  Box3d own_bounds() const;  ///< the same of the shape as the scene gives it

 private:
  friend class Simulation;
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace dreampm
