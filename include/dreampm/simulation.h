// A simulation that a program holds: it can be stepped, watched, changed, saved and drawn.
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

#include "dreampm/error.h"
#include "dreampm/host.h"
#include "dreampm/particles.h"
#include "dreampm/pose.h"
#include "dreampm/scene.h"
#include "dreampm/surface.h"
#include "dreampm/vec.h"

namespace dreampm {

struct SimulationOptions {
  std::string backend = "cpu";  ///< cpu: fast, in float; reference: plain loops, in double
  std::string isa = "auto";     ///< instruction set of the cpu backend, which decides the bits; auto: the best one
  int threads = 0;              ///< that a step uses at most; 0: all cores. Bits do not depend on it
  Host* host = nullptr;         ///< null: lines go to stderr, and an interrupt of the process stops
};

/// What one step did.
struct StepReport {
  std::uint64_t step = 0;       ///< steps so far, this one included
  double time = 0;              ///< s, after the step
  double dt = 0;                ///< s, taken
  std::string_view limiter;     ///< what limited dt: speed, wave, viscosity, frame, user
  int viscous_stages = 0;       ///< stages of viscosity in the step; 0: explicit
  bool frame_done = false;      ///< whether the step ended a frame
  double max_speed = 0;         ///< m/s, of the grid
  double j_min = 1, j_max = 1;  ///< range of the volume ratio J over all particles
};

/// The end of a frame.
struct FrameEvent {
  int frame = 1;            ///< whose time is now; frame 1 is the start
  double time = 0;          ///< s
  std::uint64_t steps = 0;  ///< in the frame that ended
};

/// Sums over all matter as it stands, and what edits brought in and took out.
struct Totals {
  std::uint64_t particles = 0;
  double mass = 0;                            ///< kg
  Vec3d momentum;                             ///< kg m/s
  double kinetic = 0;                         ///< J
  double elastic = 0;                         ///< J
  double volume = 0;                          ///< m^3
  std::uint64_t entered = 0;                  ///< particles that `add` brought, in all
  std::uint64_t removed = 0;                  ///< particles that `remove` took, in all
  std::uint64_t left = 0;                     ///< particles that left through open walls, in all
  std::uint64_t drained = 0;                  ///< particles that sinks took, in all
  double entered_mass = 0, removed_mass = 0;  ///< kg
  Vec3d entered_momentum, removed_momentum;   ///< kg m/s
};

/// A shape, as a scene file has it.
class SceneShape {
 public:
  static SceneShape box(const Vec3d& min, const Vec3d& max);     ///< corners [m]
  static SceneShape sphere(const Vec3d& center, double radius);  ///< m
  /// Upright.
  static SceneShape cylinder(const Vec3d& center, double radius, double height);  ///< m
  /// Anything that stands behind `shape:` in a scene file: "{mesh: bunny.ply, fit: {longest:
  /// 0.3}}".
  static SceneShape yaml(std::string text);
  const std::string& text() const { return text_; }

 private:
  explicit SceneShape(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// Matter that is added to a simulation.
struct NewBody {
  std::string name;      ///< not yet in use
  std::string material;  ///< of the scene
  SceneShape shape;
  Vec3d velocity{};              ///< m/s
  Vec3d spin{};                  ///< rad/s about the body's center
  std::optional<Vec3d> color{};  ///< sRGB, 0 to 1; absent: as the look of its material
};

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
};

/// What a probe of the scene has measured so far.
struct ProbeSeries {
  std::vector<std::string> columns;       ///< of a row
  std::vector<double> time;               ///< s, of each row; rises
  std::vector<std::vector<double>> rows;  ///< SI units; NaN: not defined then
};

/// A stroke of the brush: it takes along what lies within a sphere, the more the nearer to its
/// middle.
struct Stroke {
  Vec3d point;        ///< m: the middle
  double radius = 0;  ///< m, above 0
  Vec3d velocity{};   ///< m/s: where to
  double rate = 100;  ///< 1/s, at least 0: how fast matter at the middle comes to that velocity
};

/// A wall of the box.
enum class Side { x_min, x_max, y_min, y_max, z_min, z_max };

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
  /// That many steps, at least one. Velocities are kept of the last one alone, which is faster than
  /// as many calls of `step`.
  StepReport advance_steps(int count);

  double time() const;          ///< s
  int frame() const;            ///< 1 at the start
  std::uint64_t steps() const;  ///< so far
  double dt() const;            ///< s, of the step to come

  // ---- observers

  using StepObserver = std::function<void(const StepReport&)>;
  using FrameObserver = std::function<void(const FrameEvent&)>;
  /// Called after every step, in the order in which they were given. Velocities are kept in every
  /// step then, which costs some of its speed.
  void on_step(StepObserver observer);
  /// Called where a frame ends.
  void on_frame(FrameObserver observer);

  // ---- state

  const Scene& scene() const;  ///< with all edits so far
  std::size_t particle_count() const;
  /// Those of one material. Throws InputError for a name that the scene has not.
  std::size_t particle_count(std::string_view material) const;
  /// The particles of a material. Throws InputError for a name that the scene has not.
  ParticleView particles(std::string_view material) const;
  Totals totals() const;
  /// Throws InputError for a name that the scene has not.
  ColliderState collider(std::string_view name) const;
  /// The rows of a probe, which are those of its file in a run (docs/howto/measure-with-probes.md):
  /// at the start, and from then on at the ends of frames or at the probe's rate. `restore` goes
  /// back to those of its moment. Valid until the next step or `restore`. Throws InputError for a
  /// name that the scene has not.
  const ProbeSeries& probe(std::string_view name) const;
  /// Every bit that decides the future.
  std::uint64_t hash() const;

  // ---- edits

  /// A parameter of a material, as `dreampm materials` lists them; false and true are 0 and 1.
  /// Throws InputError for what a scene file would not take.
  void set_parameter(std::string_view material, std::string_view key, double value);
  /// m/s^2, from now on; replaces keyframes.
  void set_gravity(const Vec3d& gravity);
  /// `type`: separate, slip, stick or open; `friction`: Coulomb's coefficient, >= 0. Not on
  /// periodic axes.
  void set_wall(Side side, std::string_view type, double friction = 0);
  /// Moves a collider from the next step on, until another motion is set; all zero stops it where
  /// it is. It takes the place of a motion that the scene gives. Matter in contact feels the
  /// velocity of the surface, and steps get as short as it needs. A bulk modulus that the scene
  /// leaves to be derived does not know of it. Throws InputError for a name that the scene has not,
  /// or numbers that are not finite.
  void set_motion(std::string_view collider, const Twist& motion);
  /// A rigid body more, which falls, floats and meets the others from the next step on. Throws
  /// InputError for what a scene file would not take, a name in use, and a body that reaches
  /// outside of walls, into colliders or other bodies, or into matter, by more than a tenth of a
  /// cell.
  void add_rigid(const NewRigid& body);
  /// Throws InputError for a name that no rigid body has, or that a probe or a cut of the scene
  /// goes by.
  void remove_rigid(std::string_view name);
  /// Holds a rigid body at a point from now on, until another grip of it or `let_go`. Throws
  /// InputError for a name that no rigid body has, or numbers out of range.
  void hold(std::string_view rigid, const Grip& grip);
  /// Nothing happens where it is not held. Throws InputError for a name that no rigid body has.
  void let_go(std::string_view rigid);
  /// A collider more, which stands until `set_motion`. It may lie anywhere but in matter and rigid
  /// bodies, as far as those are rather than a tenth of a cell deep in it: throws InputError for
  /// that, and as `add_rigid`.
  void add_collider(const NewCollider& collider);
  /// Throws InputError for a name that no collider has, one of a rigid body or pin, or one that a
  /// probe, sink or cut of the scene goes by.
  void remove_collider(std::string_view name);
  /// Takes matter along from now on, until another stroke of the same brush or `lift_brush`: a
  /// field `brush` as scene files have it. A simulation may have many brushes, by name. Throws
  /// InputError for numbers out of range, and where the scene has a field of that name itself.
  void set_brush(std::string_view name, const Stroke& stroke);
  /// Nothing happens where there is no such brush.
  void lift_brush(std::string_view name);
  /// A material more, of which there is no particle yet; `text`: what stands behind its name in the
  /// `materials` of a scene file, as "{type: newtonian, preset: honey}", `look`: behind it in
  /// `render.looks`; empty: as scenes have it without. Throws InputError for a name that the scene
  /// has, and as a scene file does.
  void add_material(const std::string& name, const std::string& text, const std::string& look = {});
  /// All particles of one material, and what its emitters give from now on, become another's:
  /// positions, velocities and ids stay, the deformation is forgotten. They count as removed and
  /// entered. Returns how many. Throws InputError for a name that the scene has not.
  std::size_t convert(std::string_view from, std::string_view to);
  /// Forgets the deformation of a material: its particles are at rest volume, without stress and
  /// without the affine part of their velocity. Positions and velocities stay.
  void reset_state(std::string_view material);
  /// Fills a shape with a material of the scene. Throws InputError for a body that reaches outside
  /// of walls or into colliders.
  void add(const NewBody& body);
  /// Particles of a material of the scene at these places [m], all at one velocity [m/s],
  /// undeformed. They count as entered, and belong to no body. Where matter is already it is there
  /// twice. Throws InputError for a place outside of the walls or inside of a collider, and adds
  /// none then.
  void add_particles(std::string_view material, std::span<const Vec3d> positions, const Vec3d& velocity);
  /// Takes out all particles whose centers lie inside; returns how many.
  std::size_t remove(const SceneShape& region);

  // ---- memory

  Snapshot snapshot() const;
  /// Goes back to a snapshot of a simulation of the same scene, backend and instruction set. Throws
  /// InputError else.
  void restore(const Snapshot& snapshot);

  // ---- files

  /// Writes this moment as a scene that goes on from it: FILE, which must end in .yaml, and
  /// beside it the same name with .start.h5, which holds all matter. A simulation of that scene, or
  /// a run, has the same future to the bit, with the same backend and instruction set.
  /// `time.frames` of the scene is at least the frame at hand, bodies have lost their names (and
  /// their colors), brushes are fields of the scene, models are named by their whole paths. Not in
  /// it: observers, what probes have measured, and the grips of `hold`. Throws InputError for a
  /// name that scenes cannot have, and RunError where it cannot be written.
  void save(const std::filesystem::path& file) const;

  // ---- pictures

  /// The surface of a material's particles. Throws InputError for an unknown material or a setting
  /// out of range.
  TriMesh surface(std::string_view material, const SurfaceOptions& options = {}) const;

  struct Impl;
  /// For the library's own files.
  Impl& impl() { return *impl_; }
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace dreampm
