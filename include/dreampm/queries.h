// Questions about places: what a ray meets, which colliders are near, what matter touches them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

class Simulation;

/// The first surface that a ray meets.
struct RayHit {
  double distance = 0;                ///< m, from its origin
  Vec3d point;                        ///< m
  std::string name;                   ///< of the collider, rigid body or material
  std::optional<std::uint32_t> id{};  ///< of the particle; absent: it is a collider or rigid body
};

/// The first collider, rigid body or particle between the walls that a ray meets within `longest`
/// [m]. Particles are balls of half a spacing; those that hold the origin do not count. Nor do
/// walls. An origin inside of a collider gives a hit at distance 0. Looks at all particles. Throws
/// InputError for a direction without a length, or numbers that are not finite.
std::optional<RayHit> cast_ray(const Simulation& simulation, const Vec3d& origin, const Vec3d& direction,
                               double longest = std::numeric_limits<double>::infinity());

/// A collider or rigid body near a point.
struct NearCollider {
  std::string name;
  double distance = 0;    ///< m, from its surface; negative inside
  bool is_rigid = false;  ///< true if it is a rigid body
};

/// Colliders and rigid bodies whose surface is nearer to a point [m] than `distance` [m], or that
/// hold it, in the order of the scene.
std::vector<NearCollider> colliders_near(const Simulation& simulation, const Vec3d& point, double distance);

/// Matter at the surface of a collider or rigid body.
struct Contact {
  std::string material;
  std::size_t particles = 0;
  Vec3d middle{};  ///< m, of these particles
};

/// The particles that are nearer to the surface of a collider or rigid body than `distance` [m], or
/// inside of it, by material; absent: than a spacing. What they press it with is its
/// ColliderState::force. Looks at all particles. Throws InputError for a name that is not there.
std::vector<Contact> contacts(const Simulation& simulation, std::string_view collider,
                              std::optional<double> distance = {});

}  // namespace dreampm
