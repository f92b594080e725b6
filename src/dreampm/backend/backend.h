// A backend owns traversal and memory, never physics: eight bulk verbs over a World.
#pragma once
#include <array>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "dreampm/backend/impulse_sum.h"
#include "dreampm/backend/pass_stats.h"
#include "dreampm/state/regroup.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// What one visit of every node found.
struct GridStats {
  double max_speed = 0;               ///< m/s, after walls, of nodes; after sub_cycle of what particles gather of them
  double mass = 0;                    ///< kg, of all nodes
  Vec3d moment{};                     ///< kg m: sum of mass times place, which is that of the particles too
  double kinetic = 0;                 ///< J, after walls
  double arrived = 0;                 ///< J, kinetic, of what keeps velocities, before the forces
  std::array<ImpulseSum, 6> walls{};  ///< in the order of World::walls
  /// In the order of World::colliders. Inline capacity: 8 colliders without allocation.
  boost::container::small_vector<ImpulseSum, 8> colliders;
  ImpulseSum damping;
  ImpulseSum fields;  ///< force fields
  bool finite = true;

  /// All walls and colliders together.
  ImpulseSum contact() const;
};

/// Particle velocities of a pass, in the particles' order, for output: looking never changes the
/// bits.
template <class R>
struct Motion {
  struct Set {
    std::vector<Vec3<R>> velocity;  ///< m/s
    std::vector<Mat3<R>> gradient;  ///< C [1/s]
    std::vector<R> energy;          ///< J/m^3 of rest volume
    std::vector<R> volume_ratio;    ///< J
  };
  std::vector<Set> sets;
};

template <class R>
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string_view name() const = 0;
  /// The instruction set that decides the bits.
  virtual std::string_view isa() const = 0;
  /// Forgets the earlier world, and prepares all that depends on the block lists of this one, which
  /// is new or comes from a copy or a checkpoint. Changes no bit of it. The other verbs take the
  /// world that was attached last.
  virtual void attach(const World<R>& world) = 0;
  /// Regroups particles; the world stays attached.
  virtual void sort(World<R>& world) = 0;
  /// Colliders of the world stand or move otherwise than at the last `sort`. Comes between
  /// grid_update and g2p2g, so that the matter which g2p2g moves meets them where they are then.
  virtual void colliders_moved(const World<R>& world) = 0;
  /// Inserts new matter at rest state, and scatters its mass, momentum and affine motion onto the
  /// grid.
  virtual PassStats insert_particles(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) = 0;
  /// One visit per node: momentum to velocity, gravity, damping, force fields, colliders, walls.
  virtual GridStats grid_update(World<R>& world, double dt) = 0;
  /// After grid_update, which leaves these to it: gravity, stress and viscosity of the step in
  /// world.viscous_stages stages, with contact in each. Brings `found` up to date and returns the
  /// heat of viscosity [J].
  virtual double sub_cycle(World<R>& world, double dt, GridStats& found) = 0;
  /// Adds the masses of images behind walls to the grid; then gather, law, move by dt, scatter with
  /// the force of dt_next. `motion`: filled if not null.
  virtual PassStats g2p2g(World<R>& world, double dt, double dt_next, Motion<R>* motion) = 0;

  // After an edit of the particles, of their laws or of walls; begins with `sort`.

  /// What the laws of the particles say as these stand: wave speed, viscosity, range of J, whether
  /// all is finite.
  virtual PassStats state_bounds(const World<R>& world) = 0;
  /// Clears the grid and scatters mass, momentum and affine motion of all particles, and the force
  /// of world.dt_next. Laws are taken anew from the sets' values. `motion`: in the order of the
  /// particles.
  virtual void scatter_particles(World<R>& world, const Motion<R>& motion) = 0;
};

}  // namespace dreampm
