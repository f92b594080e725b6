// What a scene says, as plain data: complete (every default filled in, the variant applied) and
// checked. SI units, degrees, Y up. scene/parse.h makes it from YAML, scene/emit.h writes it back.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/geometry/sample.h"
#include "dreampm/geometry/shape.h"
#include "dreampm/math/keyframes.h"
#include "dreampm/math/motion_path.h"
#include "dreampm/math/vec.h"
#include "dreampm/physics/contact.h"
#include "dreampm/physics/param.h"
#include "dreampm/physics/spring.h"
#include "dreampm/physics/transfers.h"
#include "dreampm/scene/mark.h"
#include "dreampm/scene/probes.h"
#include "dreampm/scene/sky_kind.h"
#include "dreampm/state/force_field.h"
#include "dreampm/state/solver_kind.h"

namespace dreampm::scene {

struct Wall {
  WallType type = WallType::separate;
  double friction = 0;         ///< Coulomb's coefficient, >= 0
  bool skin_friction = false;  ///< whether it slows liquids as a smooth wall with a boundary layer does
  bool operator==(const Wall&) const = default;
};

/// Order of the walls in Space::walls.
enum WallIndex { x_min, x_max, y_min, y_max, z_min, z_max };
inline constexpr std::array<const char*, 6> wall_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

struct Space {
  Vec3d min{0, 0, 0};
  Vec3d max{1, 1, 1};        ///< rounded up to whole cells from min; the walls lie here
  Vec3d asked_max{1, 1, 1};  ///< as the scene says
  double spacing = 0.01;     ///< m, between particles
  double particles_per_cell = 8;
  std::array<Wall, 6> walls{};  ///< by WallIndex; open on periodic axes
  /// Axes whose two ends meet. Their length is rounded up to whole blocks of 4 cells.
  std::array<bool, 3> periodic{};

  double dx() const { return spacing * std::cbrt(particles_per_cell); }
  Vec3i cells() const {
    const Vec3d n = (max - min) / dx();
    return {int(std::lround(n.x)), int(std::lround(n.y)), int(std::lround(n.z))};
  }
  bool operator==(const Space&) const = default;
};

struct Time {
  double fps = 24;
  int frames = 120;  ///< frame 1 is the start, frame n is at (n - 1)/fps
  SolverKind solver = SolverKind::explicit_steps;
  double cfl = 0.5;          ///< cells that matter may cross in a step; not used with a fixed dt
  std::optional<double> dt;  ///< s, fixed step
  Mark dt_mark;
  std::optional<double> dt_max;  ///< s, longest step
  double damping = 0;            ///< 1/s: velocities decay as exp(-damping t)
  bool surface_contact = true;   ///< contact at surfaces of colliders; false: at nodes, for comparison
  bool operator==(const Time&) const = default;
};

struct Material {
  std::string name;                    ///< as the scene calls it
  const MaterialInfo* info = nullptr;  ///< its type: info->name
  Values values;                       ///< complete: every key of info->params
  AnyTransfer transfer;                ///< between its particles and the grid
  Mark mark;
};

struct Body {
  std::string name;
  int material = 0;  ///< index into SceneDescription::materials
  Shape shape;
  Vec3d velocity{};            ///< m/s
  Vec3d spin{};                ///< rad/s about the body's center
  std::optional<Vec3d> color;  ///< sRGB 0..1; absent: the look of its material
  Pattern pattern = Pattern::jitter;
  std::vector<std::string> cut;  ///< names of colliders and rigid bodies: it has no matter inside of them
  Mark mark;
};

/// How a collider moves: by keys, or at a constant velocity and spin.
struct Motion {
  std::vector<PoseKey> keys;
  bool smooth = false;         ///< ease: smooth, else linear; with keys
  Vec3d velocity{};            ///< m/s, without keys
  Vec3d spin{};                ///< rad/s, without keys
  std::optional<Vec3d> about;  ///< m: the point of the shape that it turns about; absent: its middle
};

/// What makes a collider a rigid body.
struct Rigid {
  std::optional<double> density;  ///< kg/m^3; or
  std::optional<double> mass;     ///< kg
  Vec3d velocity{}, spin{};       ///< m/s, rad/s about its center of mass, at the start
  double restitution = 0;
  std::array<bool, 6> locked{};  ///< x, y, z, rx, ry, rz
  std::optional<Spring> spring;
};

/// A collider as a mesh that deforms: a file per frame.
struct MeshSequence {
  std::vector<std::string> files;  ///< at least two, by time
  double fps = 24;                 ///< files a second, the first at time 0
  double scale = 1;                ///< m per unit of the files
};

struct Collider {
  std::string name;
  Shape shape;  ///< of one with a sequence its first mesh
  std::optional<MeshSequence> sequence;
  WallType type = WallType::separate;  ///< never open
  double friction = 0;
  double sticky = 0;                ///< Pa: the tension that it holds matter with; of type separate
  std::optional<double> voxel;      ///< m: of the distances from meshes; absent: the spacing, finer for thin walls
  bool deletes = false;             ///< on_touch: delete: matter that touches it is taken out
  std::optional<double> thickness;  ///< m: the shell about the surface of its shape, half of it on either side
  bool holds = false;               ///< whether matter that starts inside is held there
  std::optional<Motion> motion;
  std::optional<Rigid> rigid;  ///< of the section `rigid`
  bool pin = false;            ///< of the section `pins`: it only holds matter, and is not drawn
  Mark mark;
};

/// Where matter comes in.
struct Emitter {
  /// Particles of two sites of a lattice keep half a spacing.
  static constexpr double most_jitter = 0.25;

  std::string name;
  int material = 0;  ///< index into SceneDescription::materials
  Shape shape;
  std::optional<Vec3d> velocity;  ///< m/s; or
  std::vector<Key<double>> flow;  ///< m^3/s, along `direction`; one key: constant
  Vec3d direction{0, -1, 0};      ///< of the flow
  double swirl = 0;               ///< rad/s about the direction through the middle of the shape
  double jitter = 0;              ///< spacings that particles are off their places along each axis at most
  double start = 0;               ///< s
  std::optional<double> stop;     ///< s; absent: never
  std::int64_t pool = 0;          ///< particles
  bool recycle = false;           ///< whether the pool is what may be there at once, not in all
  std::optional<Motion> motion;   ///< of its shape; velocities are those in the shape
  Mark mark;
};

/// Where matter is taken out.
struct Sink {
  std::string name;
  Shape shape;
  std::optional<Motion> motion;
  Mark mark;
};

struct ForceField : dreampm::ForceField {
  Mark mark;
};

struct Output {
  std::string folder;                               ///< relative to the working folder; default out/NAME
  std::vector<std::string> attributes{"velocity"};  ///< of particle_attributes
  int checkpoint_every = 10;                        ///< frames; 0: never
  bool operator==(const Output&) const = default;
};
inline constexpr std::array<const char*, 7> particle_attributes{"velocity", "f",        "j",    "jp",
                                                                "density",  "pressure", "color"};

enum class SurfaceFormat { ply, obj, vdb };

struct Surface {
  double voxel = 0.5;  ///< in units of dx
  int smooth = 2;      ///< rounds of smoothing
  SurfaceFormat format = SurfaceFormat::ply;
  bool operator==(const Surface&) const = default;
};

struct Camera {
  bool fit_basin = true;                ///< else from, to
  double azimuth = 60, elevation = 14;  ///< degrees, with fit_basin
  double fill = 0.84;                   ///< share of the frame that the basin fills, with fit_basin
  double fov = 34;                      ///< degrees, vertical
  Vec3d from{}, to{};                   ///< m, without fit_basin
  bool operator==(const Camera&) const = default;
};

struct Sun {
  double elevation = 34, azimuth = 228;  ///< degrees
  double angle = 2.5;                    ///< degrees, radius of the visible disc
  double strength = 8;                   ///< irradiance on a plane that faces it; 0: no sun
  bool operator==(const Sun&) const = default;
};

struct Light {
  SkyKind sky = SkyKind::clear;
  Sun sun;
  bool operator==(const Light&) const = default;
};

enum class Floor { tiles, none };
enum class Basin { glass, none };

struct SceneProps {
  Floor floor = Floor::tiles;
  Basin basin = Basin::glass;
  bool operator==(const SceneProps&) const = default;
};

enum class LookType { dielectric, opaque, spheres, wood, metal, plastic };

struct Look {
  LookType type = LookType::dielectric;
  double ior = 1.333;               ///< dielectric
  Vec3d absorption{6.0, 1.7, 0.5};  ///< dielectric: 1/m, red green blue
  Vec3d color{0.93, 0.33, 0.23};    ///< all but dielectric: sRGB 0..1
  double roughness = 1;        ///< opaque: of its coat, 0 polished, 1 no coat; wood, metal, plastic: of the surface
  std::optional<double> ring;  ///< wood: m from ring to ring; absent: by the size of the body
  std::optional<Vec3d> grain;  ///< wood: along its fibers, in the scene's axes at rest; absent: the longest way
  double radius = 0.5;         ///< spheres: in units of the spacing
  bool operator==(const Look&) const = default;
};

/// What a picture leaves out, to look inside: the part of some things on that side of a plane to
/// which its normal points.
struct Cut {
  Vec3d point{};                ///< m
  Vec3d normal{};               ///< of any length above 0
  std::vector<std::string> of;  ///< names of materials, colliders and rigid bodies
  bool operator==(const Cut&) const = default;
};

struct Render {
  int width = 1920, height = 1080;  ///< pixels, both even
  int samples = 40;                 ///< at most, a pixel
  double noise = 0.009;             ///< tone-mapped error to stop at
  bool caustics = true;
  bool physical = false;  ///< leaves out what is only look
  Camera camera;
  Light light;
  SceneProps stage;
  std::optional<Cut> cut;
  std::map<std::string, Look> looks;  ///< by name: one for every material and collider
  bool operator==(const Render&) const = default;
};

struct Video {
  int quality = 18;  ///< x264's crf: 0 best, 51 worst
  bool operator==(const Video&) const = default;
};

inline constexpr std::size_t most_materials = 256;    ///< files of particles number them in 8 bits
inline constexpr std::size_t most_colliders = 65535;  ///< points of surfaces number them in 16 bits

struct SceneDescription {
  std::string name, about;
  std::uint64_t seed = 1;
  Space space;
  Time time;
  Vec3d gravity{0, -9.81, 0};              ///< m/s^2; with keys the first of them
  std::vector<Key<Vec3d>> gravity_keys{};  ///< by time; empty: constant
  std::vector<Material> materials;
  std::string start;  ///< the file of a moment to go on from, in place of bodies; empty: none
  std::vector<Body> bodies;
  std::vector<Collider> colliders;
  std::vector<Emitter> emitters;
  std::vector<Sink> sinks;
  std::vector<ForceField> fields;
  std::vector<Probe> probes;
  Output output;
  Surface surface;
  Render render;
  Video video;
};

}  // namespace dreampm::scene

namespace dreampm {
using scene::SceneDescription;
}
