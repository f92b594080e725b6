// A rigid obstacle: a shape, where it stands, how it moves, and what its surface does to matter.
#pragma once
#include <limits>
#include <memory>
#include <string>

#include "dreampm/geometry/region.h"
#include "dreampm/physics/contact.h"
#include "dreampm/pose.h"

namespace dreampm {

/// Positions in metres of the scene.
struct Collider {
  std::string name;
  std::shared_ptr<const Region> shape;  ///< as the scene gives it
  WallType type = WallType::separate;
  double friction = 0;
  /// Whether matter that starts inside is held there, as if clamped. Such a collider puts no
  /// particle back out of it.
  bool holds = false;
  Pose pose{};    ///< of the shape
  Twist twist{};  ///< of the step to come

  /// What its surface does to matter: what it holds moves with it.
  WallType contact() const { return holds ? WallType::stick : type; }
  /// Whether it may stand elsewhere than in the scene.
  bool moves() const { return !twist.at_rest() || !(pose == Pose{}); }
  /// Moves on for `dt` [s].
  void advance(double dt);

  /// Signed distance [m] from it where it stands now, negative inside.
  double distance(const Vec3d& p) const { return moves() ? shape->distance(pose.inverse(p)) : shape->distance(p); }
  /// The outward unit normal there.
  Vec3d normal(const Vec3d& p) const {
    return moves() ? pose.rotation(shape->normal(pose.inverse(p))) : shape->normal(p);
  }
  /// A box that holds it [m]; infinite where the shape is and is not turned along an axis.
  Box3d bounds() const;
  /// The largest speed [m/s] of its points within `domain`, a finite box.
  double fastest(const Box3d& domain) const;
};

}  // namespace dreampm
