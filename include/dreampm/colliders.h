// Colliders and rigid bodies of a simulation: what is added, where they stand, and their shapes.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "dreampm/pose.h"
#include "dreampm/shape.h"
#include "dreampm/vec.h"

namespace dreampm {

/// A rigid body that is added to a simulation.
struct NewRigid {
  std::string name;  ///< not yet in use, by materials and colliders neither
  SceneShape shape;
  double density = 1000;            ///< kg/m^3, from 0.1 to 30000
  std::optional<Vec3d> position{};  ///< m, of the middle of its shape; absent: where the shape says
  Vec3d velocity{};                 ///< m/s
  Vec3d spin{};                     ///< rad/s about its center of mass
  double friction = 0.4;            ///< Coulomb's coefficient, 0 to 100
  double restitution = 0;           ///< of impacts, 0 to 1
  /// What stands behind its name in `render.looks` of a scene file; empty: as scenes have it
  /// without.
  std::string look{};
};

/// A collider that is added to a simulation.
struct NewCollider {
  std::string name;  ///< not yet in use, by materials neither
  SceneShape shape;
  std::string type = "separate";  ///< what its surface does to matter: separate, slip or stick
  double friction = 0;            ///< Coulomb's coefficient, 0 to 100
  std::string look{};             ///< as in NewRigid
  /// Cells that it moves between two looks at where its surface is, above 0 to 0.25: each look
  /// takes as long as many steps. Matter feels the velocity of every step.
  double slack = 0.02;
};

/// A point of a rigid body that is drawn to a point that stands, by a damped spring. It is
/// implicit: no stiffness makes a step too long.
struct Grip {
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
  std::string_view type = "separate";  ///< what its surface does to matter: separate, slip or stick
  double friction = 0;                 ///< Coulomb's coefficient
  double restitution = 0;              ///< of impacts, 0 to 1, of a rigid body; 0 of other colliders
  double slack = 0;                    ///< cells, as in NewCollider
  bool is_rigid = false;               ///< whether it is a rigid body
  bool moves = false;                  ///< whether it may stand elsewhere than in the scene
  bool deforms = false;                ///< whether its shape changes
};

/// The shape of a collider or rigid body where the solver has its surface, which is up to `slack`
/// cells off its pose. Stays as it was when it was asked for. Cheap to copy, safe to share between
/// threads. Of use only where a Simulation gave it.
class ColliderShape {
 public:
  const std::string& name() const;
  double mass() const;                        ///< kg, of a rigid body; 0 of other colliders
  bool is_rigid() const;                      ///< whether it is a rigid body
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
