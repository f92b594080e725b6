// A backend owns traversal and memory, never physics: nine bulk verbs over a World, what brings
// its matter home, and sums over it.
#pragma once
#include <array>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "dreampm/backend/impulse_sum.h"
#include "dreampm/backend/matter_fields.h"
#include "dreampm/backend/motion.h"
#include "dreampm/backend/pass_stats.h"
#include "dreampm/backend/reductions.h"
#include "dreampm/device_arrays.h"
#include "dreampm/particles.h"
#include "dreampm/state/regroup.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The result of one visit of every node. The step needs max_speed and finite at once, for the
/// choice of dt; the rest are sums for reports.
struct GridStats {
  double max_speed = 0;               ///< m/s, after walls, of nodes; after sub_cycle of what particles gather of them
  double mass = 0;                    ///< kg, of all nodes
  Vec3d moment{};                     ///< kg m: sum of mass times place, which is that of the particles too
  double kinetic = 0;                 ///< J, after walls
  double arrived = 0;                 ///< J, kinetic, of what keeps velocities, before the forces
  std::array<ImpulseSum, 6> walls{};  ///< in the order of World::walls
  /// Impulses in the order of World::colliders. Inline capacity: 8 colliders without allocation.
  boost::container::small_vector<ImpulseSum, 8> colliders;
  ImpulseSum damping;
  ImpulseSum fields;  ///< force fields
  bool finite = true;

  /// All walls and colliders together.
  ImpulseSum contact() const;
};

/// The World is the state, and so are its arrays: the columns of particles and the nodes. A backend
/// may keep these elsewhere between its verbs (on a device). Then only the numbers of the World and
/// the sizes of its arrays are current after a verb, and the contents after `download`.
template <class R>
class Backend {
 public:
  virtual ~Backend() = default;
  virtual std::string_view name() const = 0;
  /// The instruction set that decides the bits.
  virtual std::string_view isa() const = 0;
  /// Forgets the earlier world, and prepares all that depends on the block lists of this one, which
  /// is new or comes from a copy or a checkpoint, with the contents of all its arrays. Changes no
  /// bit of it. The other verbs take the world that was attached last.
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
  /// Sub-cycles what grid_update leaves to it: gravity, stress and viscosity of the step in
  /// world.viscous_stages stages, with contact in each. Brings `found` up to date and returns the
  /// heat of viscosity [J].
  virtual double sub_cycle(World<R>& world, double dt, GridStats& found) = 0;
  /// Adds the masses of images behind walls to the grid; then gather, law, move by dt, scatter with
  /// the force of dt_next. `motion`: filled if not null; current after `download`.
  ///
  /// The next step needs wave_speed, viscosity and finite of the result; the rest are sums for
  /// reports.
  virtual PassStats g2p2g(World<R>& world, double dt, double dt_next, Motion<R>* motion) = 0;

  // After an edit of the particles, of their laws or of walls; begins with `sort`.

  /// Returns bounds from the laws of the particles in their present state: wave speed, viscosity,
  /// range of J, and whether all is finite.
  virtual PassStats state_bounds(const World<R>& world) = 0;
  /// Clears the grid and scatters mass, momentum and affine motion of all particles, and the force
  /// of world.dt_next. Laws are taken anew from the sets' values. `motion`: in the order of the
  /// particles.
  virtual void scatter_particles(World<R>& world, const Motion<R>& motion) = 0;

  // Between the backend's memory and the arrays of the World; nothing to do where they are the
  // same.

  /// Makes what `fields` name current in the World's arrays and in `motion`. Whoever reads them
  /// outside of backend/ and state/ calls it before. Changes nothing that the verbs see.
  virtual void download(World<R>& /*world*/, Motion<R>& /*motion*/, MatterFields /*fields*/) {}
  /// The same for positions of the particles near some boxes [m]: of those that for_each_near() of
  /// a ParticleSetView calls with one of the boxes. What the arrays have of others is undefined.
  virtual void download_near(World<R>& /*world*/, std::span<const Box3d> /*boxes*/) {}
  /// Takes over the `fields` that an edit changed in the World's arrays or in `motion`; later verbs
  /// and reductions use them. The order and the number of particles may differ only where all of
  /// MatterFields::particles are named.
  virtual void upload(const World<R>& /*world*/, const Motion<R>& /*motion*/, MatterFields /*fields*/) {}

  /// Copies what `fields` name of the particles of a set, for programs on the device where they
  /// lie: in their order, which is that of the World's arrays. Nothing where matter lies in the
  /// memory of the host. `motion`: that of the particles as they stand, as it was given to the last
  /// pass or to `upload`; read only where velocities are asked for.
  virtual std::optional<DeviceParticles> device_particles(const World<R>& /*world*/, const Motion<R>& /*motion*/,
                                                          std::size_t /*set*/, const ParticleFields& /*fields*/) {
    return std::nullopt;
  }

  // Reductions: sums over particles and nodes as the verbs left them, without a download. In a
  // fixed order: the same bits for any number of threads. `motion`: that of the world's last pass,
  // as it was given to it.

  virtual Balance balance(const World<R>& world, const Motion<R>& motion) { return dreampm::balance(world, motion); }
  virtual double stress_power(const World<R>& world, const Motion<R>& motion) {
    return dreampm::stress_power(world, motion);
  }
  virtual ImpulseSum grid_momentum(const World<R>& world, NodesHold hold) {
    return dreampm::grid_momentum(world, hold);
  }
};

}  // namespace dreampm
