// A simulation that a program holds: it can be stepped, watched, changed, saved and drawn. What it
// takes and gives stands in headers by subject: matter.h, colliders.h, walls.h, particles.h,
// reports.h. Questions about places (rays, what is near) are functions of queries.h, pictures of
// render.h.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/colliders.h"
#include "dreampm/device_arrays.h"
#include "dreampm/error.h"
#include "dreampm/host.h"
#include "dreampm/matter.h"
#include "dreampm/model/scene.h"
#include "dreampm/particles.h"
#include "dreampm/pose.h"
#include "dreampm/reports.h"
#include "dreampm/scene.h"
#include "dreampm/shape.h"
#include "dreampm/surface.h"
#include "dreampm/vec.h"
#include "dreampm/walls.h"

namespace dreampm {

struct SimulationOptions {
  /// cpu: fast, in float; reference: plain loops, in double; cuda: particles on an NVIDIA GPU, in
  /// float (docs/guide/gpu.md).
  std::string backend = "cpu";
  std::string isa = "auto";  ///< instruction set of the cpu backend, which decides the bits; auto: the best one
  int threads = 0;           ///< most threads that a step uses; 0: all cores. Bits do not depend on it
  Host* host = nullptr;      ///< null: lines go to stderr, and an interrupt of the process stops
};

/// The whole state of a simulation in memory. Immutable, cheap to copy, safe to share between
/// threads. Empty unless Simulation::snapshot gave it.
class Snapshot {
 public:
  bool empty() const { return !data_; }
  double time() const;          ///< s; 0 of an empty one
  std::uint64_t bytes() const;  ///< of memory, about

 private:
  friend class Simulation;
  struct Data;
  std::shared_ptr<const Data> data_;
};

/// The steps over which the force on a collider is averaged: those of this call, or those of the
/// call before too.
enum class ForceMean { of_this_call, goes_on };

/// A scene that runs in this program.
///
/// Time moves by whole steps, whose length the solver chooses; the last step of a frame ends
/// exactly at the frame's time. The same calls give the same bits, for any number of threads and
/// after `restore`.
///
/// A Simulation is used by one thread at a time. Several may run side by side.
///
/// Edits act from the next step on: particles keep positions, velocities and deformation, and the
/// grid is formed anew, so that no force of before is left. They may stand between steps and inside
/// of observers. In a scene with a fixed `time.dt`, what forms the grid (the next step, dt, hash,
/// snapshot) throws InputError while an edit asks for shorter steps.
///
/// What can be set can be read back, at once: `set_gravity` and `gravity`, `attach` and `anchor`.
/// What takes a name throws InputError for one that is not there, unless it says what it does then.
class Simulation {
 public:
  /// Fills the bodies with particles. Throws InputError as `dreampm run` does for a scene that
  /// cannot start or an unknown backend.
  explicit Simulation(const Scene& scene, const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  // ---- time

  /// One step. Throws NumericalFailure where the numbers stop being numbers; the simulation can
  /// then only be restored. Throws what an observer threw, after the step is whole.
  StepReport step();
  /// Steps until the time [s] is reached, which the last step may pass by less than its length;
  /// nothing where it has passed. Throws InputError for a time that is not a finite number.
  void advance_to(double time);
  /// Steps to the end of that many frames.
  void advance_frames(int count);
  /// Makes `count` steps, at least one. Only the velocities of the last step are kept, which makes
  /// this faster than as many calls of `step`.
  StepReport advance_steps(int count, ForceMean mean = ForceMean::of_this_call);

  double time() const;          ///< s
  int frame() const;            ///< 1 at the start
  std::uint64_t steps() const;  ///< so far
  double dt() const;            ///< s, of the step to come
  /// Cells that sound or matter may cross in a step from now on (`time.cfl`). Throws InputError for
  /// what a scene file would not take.
  void set_cfl(double cfl);
  double cfl() const;
  Stepping stepping() const;  ///< all that the length of steps goes by

  // ---- observers

  using StepObserver = std::function<void(const StepReport&)>;
  using FrameObserver = std::function<void(const FrameEvent&)>;
  /// Called after every step, in the order in which they were given. Velocities are kept in every
  /// step then, which costs some of its speed.
  void on_step(StepObserver observer);
  /// Called where a frame ends.
  void on_frame(FrameObserver observer);

  // ---- what there is

  const Scene& scene() const;  ///< with all edits so far
  Names names() const;
  std::string backend() const;  ///< as in SimulationOptions
  std::string isa() const;      ///< the instruction set that it computes by: avx2, baseline, ...
  int threads() const;          ///< most threads that a step uses
  /// Sums over all matter. Looks at all particles.
  Totals totals() const;
  /// Returns the numbers of particles that there are, and that came and went. Reads no particle.
  ParticleCounts counts() const;
  /// The rows of a probe, which are those of its file in a run (docs/howto/measure-with-probes.md):
  /// at the start, and from then on at the ends of frames or at the probe's rate. `restore` goes
  /// back to those of its moment. Valid until the next step, `restore` or `load`.
  const ProbeSeries& probe(std::string_view name) const;
  /// Every bit that decides the future.
  std::uint64_t hash() const;

  // ---- particles

  std::size_t particle_count() const;
  std::size_t particle_count(std::string_view material) const;
  /// The particles of a material, copied out in the order of their ids. Asked for again between two
  /// steps or edits, it costs nothing.
  ParticleView particles(std::string_view material) const;
  /// A number of each particle of a material, as particle files have it: `f`, the deformation
  /// gradient [1], 3 x 3; `j`, volume over volume at rest [1]; `jp`, the plastic part of it [1];
  /// `density` [kg/m^3]; `pressure` [Pa]; `velocity_gradient` [1/s], 3 x 3. Where a material keeps
  /// no `f` or `jp` they are those of matter at rest. Others are what the material keeps beside
  /// them. Throws InputError for a name that `attributes` does not list, with the one that may be
  /// meant.
  AttributeView attribute(std::string_view material, std::string_view name) const;
  std::vector<std::string> attributes(std::string_view material) const;
  /// Calls `see` with the particles of a material, some at a time, in the order in which they lie
  /// in memory, which is another one after each step. Nothing is copied but what a batch shows.
  void visit(std::string_view material, const ParticleFields& fields,
             const std::function<void(const ParticleBatch&)>& see) const;
  /// Copies the particles of a material for programs on the GPU where they lie; nothing goes to the
  /// host. Arrays are in the order of memory, which may change with each step, with the ids beside.
  /// Throws InputError where the backend, or the projection, keeps particles in the host's memory,
  /// and RunError where the device has no room, or where velocities are not known because the steps
  /// before were interrupted.
  DeviceParticles device_particles(std::string_view material, const ParticleFields& fields = {true, true, true}) const;
  /// All particles that are there have ids below this one, and those that come in later do not.
  std::uint32_t next_id() const;

  /// Fills a shape with a material of the scene. Throws InputError for what `check` would not take,
  /// a name in use, and a body that reaches outside of walls or into colliders.
  void add(const model::Body& body);
  BodyState body(std::string_view name) const;
  /// Particles of a material of the scene at these places [m], all at one velocity [m/s],
  /// undeformed. They count as entered, and belong to no body. Where matter is already it is there
  /// twice. Throws InputError for a place outside of the walls or inside of a collider, and adds
  /// none then.
  void add_particles(std::string_view material, std::span<const Vec3d> positions, const Vec3d& velocity);
  /// The same, each with a velocity and its gradient.
  void add_particles(std::string_view material, std::span<const NewParticle> particles);
  /// Takes out all particles whose centers lie inside; returns how many.
  std::size_t remove(const Shape& region);

  // ---- materials

  /// A parameter of a material, as `dreampm materials` lists them; false and true are 0 and 1.
  /// Throws InputError for what a scene file would not take.
  void set_parameter(std::string_view material, std::string_view key, double value);
  /// NaN: the solver works it out. Throws InputError for a key that the material has not.
  double parameter(std::string_view material, std::string_view key) const;
  /// All of them, with units and ranges.
  std::vector<Parameter> parameters(std::string_view material) const;
  /// Returns derived values of a material as it stands, or as it would be with other values of some
  /// parameters. Changes nothing. Throws InputError for a key that the material does not have.
  MaterialState material(std::string_view name, std::span<const ParameterValue> with = {}) const;
  /// A material more, of which there is no particle yet. Without a look it has that of scenes which
  /// say none. Throws InputError for a name that the scene has, and for what `check` would not
  /// take.
  void add_material(const model::Material& material, const std::optional<model::Look>& look = {});
  /// All particles of one material, and what its emitters give from now on, become another's:
  /// positions, velocities and ids stay, the deformation is forgotten. They count as removed and
  /// entered. Returns how many.
  std::size_t convert(std::string_view from, std::string_view to);
  /// Forgets the deformation of a material: its particles are at rest volume, without stress and
  /// without the affine part of their velocity. Positions and velocities stay.
  void reset_state(std::string_view material);

  // ---- gravity and walls

  /// m/s^2, from now on; replaces keyframes.
  void set_gravity(const Vec3d& gravity);
  Vec3d gravity() const;  ///< m/s^2, now
  /// Throws InputError on periodic axes, which have no walls.
  void set_wall(Side side, const Wall& wall);
  Wall wall(Side side) const;

  // ---- colliders and rigid bodies

  ColliderState collider(std::string_view name) const;
  ColliderShape collider_shape(std::string_view name) const;
  std::vector<ColliderShape> collider_shapes() const;  ///< of all, in the order of Names::colliders
  /// The surface of a collider as the scene gives it, to be drawn at its pose [m]. Of a plane it is
  /// what lies between the walls, of one that deforms its first mesh.
  TriMesh collider_mesh(std::string_view name) const;
  /// Moves a collider from the next step on, until another motion is set; all zero stops it where
  /// it is. It takes the place of a motion that the scene gives. Matter in contact feels the
  /// velocity of the surface, and steps get as short as it needs. A bulk modulus that the scene
  /// leaves to be derived does not know of it. Throws InputError for numbers that are not finite.
  void set_motion(std::string_view collider, const Twist& motion);
  /// Cells that it moves between two looks at where its surface is, above 0 to 0.25, from its next
  /// move on: each look takes as long as many steps. Matter feels the velocity of every step. 0.02
  /// at first.
  void set_surface_tolerance(std::string_view collider, double cells);
  /// A collider more. A rigid body falls, floats and meets the others from the next step on; others
  /// move as they say, by the simulation's time, or stand until `set_motion`. The first rigid body
  /// of a scene reads the meshes of its colliders again. Without a look it has that of scenes which
  /// say none. Throws InputError for what `check` would not take, a name in use, one that holds
  /// matter, which is of the start of a scene, one that lies in matter by more than a tenth of a
  /// cell, and a rigid body that reaches as far outside of walls, into colliders or other bodies.
  void add(const model::Collider& collider, const std::optional<model::Look>& look = {});
  /// Holds a rigid body at a point from now on, until it is attached elsewhere or `detach`. Throws
  /// InputError for a name that no rigid body has, or numbers out of range.
  void attach(std::string_view rigid, const SpringAnchor& anchor);
  std::optional<SpringAnchor> anchor(std::string_view rigid) const;  ///< nothing where it is not held
  /// Lets go of a rigid body; does nothing where it is not held. Throws InputError for a name that
  /// no rigid body has.
  void detach(std::string_view rigid);
  void detach();  ///< of all
  /// A rigid body or another one. Throws InputError for a name that none has, one of a pin, or one
  /// that a probe, sink or cut of the scene goes by.
  void remove_collider(std::string_view name);

  // ---- brushes

  /// Takes matter along from now on, until another stroke of the same brush or `remove_brush`: a
  /// field `brush` as scene files have it. A simulation may have many brushes, by name. Throws
  /// InputError for numbers out of range, and where the scene has a field of that name itself.
  void set_brush(std::string_view name, const VelocityBrush& stroke);
  std::optional<VelocityBrush> brush(std::string_view name) const;  ///< nothing where there is no such brush
  /// Removes a brush; does nothing where there is no such brush.
  void remove_brush(std::string_view name);

  // ---- memory

  Snapshot snapshot() const;
  /// Goes back to a snapshot of a simulation of the same scene: to the very bits, and with another
  /// backend or instruction set of the same precision on from there to rounding. Throws InputError
  /// else.
  void restore(const Snapshot& snapshot);

  // ---- files

  /// Writes this moment as a scene that goes on from it: FILE, which must end in .yaml, and
  /// beside it the same name with .start.h5, which holds all matter. A simulation of that scene, or
  /// a run, has the same future to the bit, with the same backend and instruction set.
  /// `time.frames` of the scene is at least the frame at hand, bodies have lost their names (and
  /// their colors), brushes are fields of the scene, models are named by their whole paths. Not in
  /// it: observers, what probes have measured, and the anchors of `attach`. Throws InputError for a
  /// name that scenes cannot have, and RunError where it cannot be written.
  void save(const std::filesystem::path& file) const;
  /// Goes on from what `save` wrote, or starts any other scene file: as a new Simulation of it,
  /// with the backend, threads, host and observers of this one. Throws InputError as that does, and
  /// for a call inside of an observer; nothing has changed then.
  void load(const std::filesystem::path& file);
  /// Writes the matter of this moment alone, for the `start` of a scene
  /// (docs/howto/start-from-a-moment.md).
  void save_moment(const std::filesystem::path& file) const;
  /// The same for `finer`, which is this scene at half the spacing: each particle becomes eight, in
  /// the middles of the eighths of the cube that it takes, deformed as it is, at its state, its
  /// velocity and the velocity's change over the cube. Mass and momentum stay, as do the emitter
  /// that it came from and when. What would lie behind a wall or in a collider is moved out of it.
  /// Throws InputError where there is no memory for them.
  void save_moment(const std::filesystem::path& file, const Scene& finer) const;

  // ---- surfaces

  /// The surface of a material's particles. Throws InputError for a setting out of range.
  TriMesh surface(std::string_view material, const SurfaceOptions& options = {}) const;

  struct Impl;

 private:
  friend struct SimulationAccess;  // the library's own files
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm
