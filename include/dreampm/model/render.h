// Output of a run and appearance of its matter: files, surfaces, looks, camera, light, video.
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/vec.h"

namespace dreampm {

enum class SkyKind {
  clear,    ///< blue, with soft clouds and a glow round the sun
  studio,   ///< soft boxes in a gray room
  night,    ///< dark
  uniform,  ///< radiance 1 everywhere: for tests; no scene asks for it
};

namespace model {

/// The files that `dreampm run` writes.
struct Output {
  std::string folder;                               ///< relative to the working folder; empty: out/NAME
  std::vector<std::string> attributes{"velocity"};  ///< of particle_attributes
  int checkpoint_every = 10;                        ///< frames; 0: never
  bool operator==(const Output&) const = default;
};
inline constexpr std::array<const char*, 9> particle_attributes{"velocity", "f",     "j",      "jp", "density",
                                                                "pressure", "color", "source", "age"};

/// What is written beside the mesh.
enum class SurfaceType {
  mesh,  ///< nothing
  fog,   ///< an OpenVDB fog volume of the field that the mesh is a contour of
  sdf    ///< an OpenVDB level set of distances from the mesh
};
enum class SurfaceFormat { ply, obj };
inline constexpr std::array<const char*, 6> surface_attributes{"velocity", "color", "source", "age", "j", "vorticity"};

/// The settings of the surface that is wrapped around particles.
struct Surface {
  double voxel = 0.5;                               ///< in units of dx
  int smooth = 2;                                   ///< rounds of smoothing, 0 to 10
  std::vector<std::string> attributes{"velocity"};  ///< of the vertices; of surface_attributes
  SurfaceType type = SurfaceType::mesh;
  SurfaceFormat format = SurfaceFormat::ply;
  double overlap = 0.5;               ///< spacings that it reaches into walls and colliders, 0 to 1
  std::optional<double> drop_life{};  ///< s until a small drop that rests on something is gone; absent: it stays
  bool operator==(const Surface&) const = default;
};

enum class LookType { dielectric, opaque, spheres, wood, metal, plastic };
inline constexpr std::array<std::string_view, 6> look_type_names{"dielectric", "opaque", "spheres",
                                                                 "wood",       "metal",  "plastic"};

/// The appearance of a material, collider or rigid body.
struct Look {
  LookType type = LookType::dielectric;
  double ior = 1.333;               ///< dielectric, 1 to 3
  Vec3d absorption{6.0, 1.7, 0.5};  ///< dielectric: 1/m, red green blue
  Vec3d scattering{};               ///< dielectric: 1/m, red green blue; 0: clear
  double anisotropy = 0;            ///< dielectric: mean cosine of scattering, -0.95 to 0.95
  Vec3d color{0.93, 0.33, 0.23};    ///< all but dielectric: sRGB 0..1
  double roughness = 1;          ///< opaque: of its coat, 0 polished, 1 no coat; wood, metal, plastic: of the surface
  std::optional<double> ring{};  ///< wood: m from ring to ring; absent: by the size of the body
  std::optional<Vec3d> grain{};  ///< wood: along its fibers, in the scene's axes at rest; absent: the longest way
  double radius = 0.5;           ///< spheres: in units of the spacing
  bool operator==(const Look&) const = default;

  /// Clear matter, such as water or glass; cloudy where it scatters, as milk.
  static Look dielectric(double ior = 1.333, const Vec3d& absorption = {6.0, 1.7, 0.5}, const Vec3d& scattering = {},
                         double anisotropy = 0) {
    Look look;
    look.ior = ior, look.absorption = absorption, look.scattering = scattering, look.anisotropy = anisotropy;
    return look;
  }
  static Look opaque(const Vec3d& color, double roughness = 1) { return of(LookType::opaque, color, roughness); }
  static Look wood(const Vec3d& color = {0.74, 0.54, 0.33}, double roughness = 0.45) {
    return of(LookType::wood, color, roughness);
  }
  static Look metal(const Vec3d& color = {0.77, 0.78, 0.79}, double roughness = 0.3) {
    return of(LookType::metal, color, roughness);
  }
  static Look plastic(const Vec3d& color = {0.62, 0.09, 0.07}, double roughness = 0.2) {
    return of(LookType::plastic, color, roughness);
  }

 private:
  static Look of(LookType type, const Vec3d& color, double roughness) {
    Look look;
    look.type = type, look.color = color, look.roughness = roughness;
    return look;
  }
};

struct Camera {
  bool fit_basin = true;  ///< it stands so that the box of the scene fills the picture; else from, to
  double azimuth = 60;    ///< degrees, with fit_basin
  double elevation = 14;  ///< degrees, with fit_basin
  double fill = 0.84;     ///< share of the frame that the box fills, with fit_basin
  double fov = 34;        ///< degrees, vertical
  Vec3d from{}, to{};     ///< m, without fit_basin
  /// The share of the time from frame to frame through which each picture is exposed, 0 to 1, half
  /// of it before the frame and half after; 0: an instant.
  double shutter = 0;
  double aperture = 0;                 ///< m, the diameter of the lens; 0: a pinhole, all is sharp
  std::optional<double> fstop{};       ///< the f-number, in place of the diameter, of film 24 mm high
  std::optional<double> focus{};       ///< m, from the eye to the plane that is sharp, along the line of sight
  std::optional<Vec3d> focus_point{};  ///< m: a point of that plane. Both absent: the middle of the box, or `to`
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
  /// A picture of all around in place of the sky: an OpenEXR file of equal steps of longitude and
  /// latitude, its middle towards +x. Empty: none.
  std::string environment;
  double turn = 0;      ///< degrees, of the environment about +y
  double strength = 1;  ///< by which the environment's radiance is multiplied, > 0
  Sun sun;
  bool operator==(const Light&) const = default;
};

/// The place where it all stands: what its floor is of, and lamps and backdrops.
enum class Place {
  terrace,  ///< tiles to the horizon
  studio,   ///< a paper backdrop that bends up behind
  night,    ///< dark tiles between four lamps
};
enum class Floor { tiles, none };
enum class Basin { glass, none };

/// The objects around the matter in a picture.
struct SceneProps {
  Place place = Place::terrace;
  Floor floor = Floor::tiles;
  Basin basin = Basin::glass;
  bool operator==(const SceneProps&) const = default;
};

/// A cut, which shows the inside: pictures leave out the part of some objects on that side of a
/// plane to which its normal points.
struct Cut {
  Vec3d point{};                ///< m
  Vec3d normal{};               ///< of any length above 0
  std::vector<std::string> of;  ///< names of materials, colliders and rigid bodies
  bool operator==(const Cut&) const = default;
};

enum class PictureFormat { png, exr };

/// The settings of pictures.
struct Render {
  int width = 1920, height = 1080;  ///< pixels, both even
  int samples = 40;                 ///< at most, a pixel
  double noise = 0.009;             ///< tone-mapped error to stop at
  bool caustics = true;
  bool physical = false;  ///< leaves out what is only look
  bool denoise = false;   ///< Open Image Denoise takes the noise out
  PictureFormat format = PictureFormat::png;
  Camera camera;
  Light light;
  SceneProps stage;
  std::optional<Cut> cut;
  /// Looks by name. Where the scene gives none, honey and snow have their own, other liquids that
  /// of water, and all else a matte color.
  std::map<std::string, Look> looks;
  bool operator==(const Render&) const = default;
};

struct Video {
  int quality = 18;  ///< x264's crf: 0 best, 51 worst
  bool operator==(const Video&) const = default;
};

}  // namespace model
}  // namespace dreampm
