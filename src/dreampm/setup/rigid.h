// The rigid bodies of a scene, as the solver takes them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// Returns the shape with which bodies meet a collider. Throws InputError for a mesh that cannot be
/// read.
CollisionShape collision_shape(const model::Collider& given, const model::Space& space);

/// Makes collider `c` of the world a rigid body: mass, center and inertia of its shape, its motion
/// at the start. What is wrong goes to `errors`.
template <class R>
void make_rigid(World<R>& world, std::size_t c, const model::Collider& given, const model::Space& space,
                std::vector<std::string>& errors);

/// Returns the fault of a rigid body that begins inside of another collider that it should meet;
/// both numbers are of colliders.
template <class R>
std::optional<std::string> starts_inside(const World<R>& world, std::size_t body, std::size_t other);

/// Makes those colliders of a world rigid bodies that the scene says are: mass, center and inertia
/// of their shapes, and what they meet other bodies with. What is wrong, a body inside of another
/// or of a collider, goes to `errors`, a line each; `file` names the scene.
void add_rigid(World<double>& world, const model::Scene& scene, const std::string& file,
               std::vector<std::string>& errors);

}  // namespace dreampm
