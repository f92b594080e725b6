// World: the whole state of a simulation as a plain value. Copy = undo, hash = identity, save =
// restart.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/base/large_vector.h"
#include "dreampm/math/keyframes.h"
#include "dreampm/model/space.h"
#include "dreampm/physics/dt.h"
#include "dreampm/physics/fields.h"
#include "dreampm/physics/param.h"
#include "dreampm/physics/transfer_rule.h"
#include "dreampm/state/collider.h"
#include "dreampm/state/force_field.h"
#include "dreampm/state/grid.h"
#include "dreampm/state/inflow.h"
#include "dreampm/state/rigid_body.h"
#include "dreampm/state/scene_position.h"

namespace dreampm {

/// The particles of one named material. Mass and rest volume are the same for all of them.
/// Particles lie sorted by block: those of block b of World::particle_blocks are [block_start[b],
/// block_start[b + 1]).
template <class R>
struct ParticleSet {
  std::string name;      ///< the material's name in the scene
  std::string material;  ///< its type: newtonian, elastic, ...
  Values values;         ///< complete, bulk modulus derived
  bool liquid = false;
  double mass = 0;         ///< kg, of one particle
  double rest_volume = 0;  ///< m^3, of one particle

  TransferRule<double> transfer;  ///< between particles and grid
  /// Velocity and its gradient lie on the particles between steps: the projection's (SolverKind).
  bool carries_motion = false;

  std::vector<std::uint32_t> id;
  /// Position in cells relative to the first_stencil() of its block, minus 1/2: in [0, 4) after a
  /// sort, in (-1, 5) until the next.
  std::array<LargeVector<R>, 3> u;
  std::vector<LargeVector<R>> state;           ///< the material's columns
  std::array<LargeVector<R>, 3> own_velocity;  ///< velocity [m/s], where it is kept, else empty
  /// C [1/s], dv_a/dx_b in column 3 a + b; where the set carries its motion, else empty.
  std::array<LargeVector<R>, 9> gradient;
  std::vector<std::uint32_t> block_start;

  std::size_t size() const { return id.size(); }
  bool has_own_velocity() const { return carries_motion || transfer.keeps_velocity(); }
  /// The edge of the cube that a particle takes at rest [m].
  double spacing() const { return std::cbrt(rest_volume); }
};

/// Times and limits of the steps; they decide the future and so are state.
struct StepSettings {
  SolverKind solver = SolverKind::explicit_steps;
  double fps = 24;  ///< frames a second of simulated time
  double cfl = 0.5;
  double fixed_dt = 0;     ///< s; 0: from the bounds
  double dt_max = 1e30;    ///< s
  bool sub_cycles = true;  ///< true if steps may be longer than explicit viscosity allows
  double damping = 0;      ///< 1/s: node velocities decay by exp(-damping dt)
  /// Keep particles inside walls, and let solids and grains touch these only when particles are
  /// there; false: walls act on nodes alone.
  bool keep_inside = true;
  /// Contact with colliders acts at points of their surfaces; false, for comparison: at the nodes
  /// inside of them.
  bool surface_contact = true;
};

template <class R>
struct World {
  std::uint64_t step = 0;
  int frame = 1;
  double time = 0;     ///< s
  double dt_next = 0;  ///< s; the step that is baked into the carried grid; 0 before the first matter
  Limiter dt_limiter = Limiter::user;
  /// s: the step whose shares of own velocities weigh the carried grid's; 0 where no set has a
  /// memory.
  double kept_for = 0;
  /// Number of stages in which the forces of that step act, so that viscosity can; 0: they are
  /// baked, all at once.
  int viscous_stages = 0;
  double dx = 0;              ///< m, a cell
  Vec3d origin;               ///< m, the scene position of node `low`
  Vec3i low, high;            ///< node planes of the domain walls
  std::array<Wall, 6> walls;  ///< x_min, x_max, y_min, y_max, z_min, z_max
  /// Axes whose two ends meet. Their walls are open, `low` begins a block, and the length is whole
  /// blocks.
  std::array<bool, 3> periodic{};
  Vec3d gravity;                         ///< m/s^2, where it does not change
  std::vector<Key<Vec3d>> gravity_keys;  ///< m/s^2; if there are any, they stand instead of `gravity`
  std::vector<ForceField> fields;
  StepSettings settings;
  std::vector<ParticleSet<R>> sets;
  std::vector<Vec3i> particle_blocks;  ///< blocks that particles lie in, lexicographic
  GridFields<R> grid;
  std::vector<Collider> colliders;
  std::vector<RigidBody> rigid;
  std::vector<CollisionShape> collision;  ///< one for each collider, where there are rigid bodies
  std::vector<Emitter> emitters;
  std::vector<Sink> sinks;
  double emitted_until = -1;       ///< s; time up to which emitters have given matter
  std::vector<Arrival> arrivals;   ///< what emitters gave, by rising ids; reported, not state
  std::uint32_t next_id = 0;       ///< id of the next particle from an emitter; 0 without emitters
  double drift = 0;                ///< bound on the cells that a particle moved since the last sort
  double wave_speed = 0;           ///< m/s, largest of the last pass
  double viscosity = 0;            ///< m^2/s, largest kinematic viscosity of the last pass
  double kept_kinetic_energy = 0;  ///< J, of sets that keep velocities, in the last pass; reported, not state
  std::uint64_t left = 0;          ///< particles that left through open walls, in all
  /// The largest speed [m/s], mass of a node [kg], volume ratio [1] and viscosity [m^2/s] of what
  /// the last pass gave to the nodes; only of backends that add whole numbers there, whose units
  /// follow from it.
  std::array<double, 4> scatter_bounds{};
  double node_speed = 0;  ///< m/s, largest of this step's nodes; not state: every step finds it anew
  double dt_before = 0;   ///< s, of the last step of a projection; 0 before the first
  /// Pa, of the cells of grid.blocks, a cell by its node of lowest coordinates; only of a
  /// projection, whose next solve begins from it.
  LargeVector<R> cell_pressure;

  std::size_t particles() const {
    std::size_t n = 0;
    for (const auto& s : sets) n += s.size();
    return n;
  }
  /// Gravity at a time [s]: the gravity of potential energy.
  Vec3d gravity_at(double t) const {
    return gravity_keys.empty() ? gravity : value_at(std::span<const Key<Vec3d>>(gravity_keys), t);
  }
  /// Returns the mean gravity over a step from now: the gain of velocity is exact, whatever dt.
  Vec3d gravity_over(double dt) const {
    return gravity_keys.empty() ? gravity : mean_over(std::span<const Key<Vec3d>>(gravity_keys), time, time + dt);
  }
  /// True if there are liquids and solids: these move in velocity fields of their own, so that one
  /// can slide along the other.
  bool needs_solid_field() const {
    bool liquid = false, solid = false;
    for (const auto& s : sets) (s.liquid ? liquid : solid) = true;
    return liquid && solid;
  }
  /// True if that field of the grid is the liquids': then nothing else moves in it.
  bool holds_liquid(std::size_t field) const {
    return field == 0 && std::any_of(sets.begin(), sets.end(), [](const auto& s) { return s.liquid; });
  }
  /// Returns the field of the grid in which a set moves: 0 nodes, 1 solids.
  std::size_t field_of(const ParticleSet<R>& set) const { return needs_solid_field() && !set.liquid ? 1 : 0; }
  /// The largest share of own velocities that a set of the field keeps; 0 if none does.
  double kept_share(std::size_t field) const {
    double share = 0;
    for (const auto& s : sets)
      if (field_of(s) == field) share = std::max(share, s.transfer.kept(kept_for));
    return share;
  }
  bool keeps_velocities(std::size_t field) const {
    return std::any_of(sets.begin(), sets.end(),
                       [&](const auto& s) { return field_of(s) == field && s.transfer.keeps_velocity(); });
  }
  /// Says that the grid was formed for a step of `dt` [s].
  void formed_for(double dt) {
    const bool any = std::any_of(sets.begin(), sets.end(), [](const auto& s) { return s.transfer.memory > 0; });
    kept_for = any ? dt : 0;
  }
  /// Returns the bound of a particle's speed over that of the fastest node: 2 where a transfer
  /// moves matter by its own velocity.
  double reach() const {
    for (const auto& s : sets)
      if (s.transfer.advance > 0 && s.transfer.keeps_velocity()) return 2;
    return 1;
  }
  /// True if the field's matter has several densities and a law in it asks for the density around a
  /// particle, which the masses of nodes then do not show.
  bool measures_by_volume(std::size_t field) const;
  /// True if anything asks what matter there is at a node: contact of liquids with solids, walls
  /// how viscous a liquid is, a law its density among others.
  bool mixes_matter() const {
    return needs_solid_field() || (holds_liquid(0) && has_skin_friction()) || measures_by_volume(0) ||
           measures_by_volume(1);
  }
  /// Liquids need to know how much of a node's kernel colliders take, too.
  bool needs_mixture() const { return mixes_matter() || (holds_liquid(0) && !colliders.empty()); }
  bool has_skin_friction() const {
    for (const Wall& w : walls)
      if (w.skin_friction) return true;
    return false;
  }
  /// Returns the number of ways in which walls and solids hold liquids by viscosity.
  int viscous_contacts() const { return (holds_liquid(0) && has_skin_friction()) + needs_solid_field(); }
  /// The block that stands for `b`: on periodic axes the one of the domain that it is a copy of.
  Vec3i wrapped(Vec3i b) const {
    for (int a = 0; a < 3; ++a) {
      if (!periodic[static_cast<std::size_t>(a)]) continue;
      const std::int32_t first = low[a] / block_width, count = (high[a] - low[a]) / block_width;
      b[a] = first + ((b[a] - first) % count + count) % count;
    }
    return b;
  }
  /// Makes the domain a box of `cells` cells. Stencils of matter on a wall begin one node behind
  /// it. Walls at `low` lie so that a block of particles begins there: a layer on a floor is then
  /// in as few blocks as can be.
  void set_domain(const Vec3i& cells) {
    for (int a = 0; a < 3; ++a) low[a] = periodic[static_cast<std::size_t>(a)] ? 0 : first_stencil({})[a] + 1;
    high = low + cells;
  }
  /// Returns the box between the walls [m].
  Box3d domain() const { return {node_position(low), node_position(high)}; }
  /// The largest speed of a collider's surface in the domain [m/s], from now to `ahead` [s] later.
  double collider_speed(double ahead) const {
    double speed = 0;
    for (const Collider& c : colliders)
      if (c.path || !c.stands()) speed = std::max(speed, c.fastest(domain(), time, ahead));
    return speed;
  }
  /// Gives colliders with a path the twist of the step of dt_next that comes; whether there are
  /// any.
  bool aim_colliders() {
    bool any = false;
    for (Collider& c : colliders) {
      any = any || c.path || c.changing;
      c.follow(time, dt_next);
      if (c.moves()) c.settle(0);
    }
    return any;
  }
  /// The scene position [m] of node `n`.
  Vec3d node_position(const Vec3i& n) const { return origin + static_cast<Vec3d>(n - low) * dx; }
  /// From blocks of particles to the scene.
  ScenePosition scene_position() const {
    ScenePosition to{origin, dx, low, {}};
    for (int a = 0; a < 3; ++a)
      if (periodic[static_cast<std::size_t>(a)]) to.period[a] = high[a] - low[a];
    return to;
  }
  /// The scene position [m] of a particle of block `b` at `at`, as in ParticleSet::u, within the
  /// domain on periodic axes.
  Vec3d position(const Vec3i& b, const Vec3<R>& at) const { return scene_position()(b, at); }
  /// A particle's block, within the domain on periodic axes, and its place there.
  struct BlockPosition {
    Vec3i block;
    Vec3<R> at;
  };
  BlockPosition locate(const Vec3d& position) const {
    const Vec3d cells = (position - origin) * (1 / dx);
    Vec3i node;
    for (int a = 0; a < 3; ++a) node[a] = low[a] + static_cast<std::int32_t>(std::floor(cells[a] - 0.5));
    const Vec3i block = particle_block_of(node), first = first_stencil(block) - low;
    Vec3<R> at;
    for (int a = 0; a < 3; ++a) at[a] = static_cast<R>(cells[a] - 0.5 - first[a]);
    return {wrapped(block), at};
  }
};

/// Every bit that decides the future, particles in the order of their ids, independent of where in
/// space the scene lies.
template <class R>
std::uint64_t state_hash(const World<R>& world);

}  // namespace dreampm
