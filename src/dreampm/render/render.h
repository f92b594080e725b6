// Pictures of a frame: water, opaque meshes and spheres in an open glass basin on a tiled floor,
// under sun and sky. A path tracer over Embree; the floor's light is baked first, so that caustics
// come with it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/io/png.h"
#include "dreampm/math/vec.h"
#include "dreampm/model/render.h"

namespace dreampm {

/// A smooth interface around a clear medium that absorbs by Beer-Lambert: water, honey, glass.
struct DielectricLook {
  float ior = 1.333f;                  ///< 1.01 to 3
  Vec3f absorption{6.0f, 1.7f, 0.5f};  ///< 1/m for red, green, blue; >= 0
  Vec3f glow{0.03f, 0.22f, 0.34f};     ///< radiance scattered inside a thick layer: a look, left out if physical
};
/// A matte surface, under a clear coat where roughness < 1.
struct OpaqueLook {
  Vec3f color{0.8f, 0.8f, 0.8f};  ///< linear reflectance, 0 to 1
  float roughness = 1;            ///< of the coat, 0 (polished) to 1 (no coat)
};
/// Wood under a satin varnish: rings about a pith, and fibers along it, in the frame of its object.
struct WoodLook {
  Vec3f color{0.51f, 0.25f, 0.09f};  ///< linear reflectance of the early wood, 0 to 1; late wood is darker
  float roughness = 0.45f;           ///< of the varnish, 0 to 1
  float ring = 0;                    ///< m from ring to ring; 0: by the size of the object
};
/// A rough conductor.
struct MetalLook {
  Vec3f color{0.56f, 0.57f, 0.58f};  ///< linear reflectance square to the surface, 0 to 1
  float roughness = 0.3f;            ///< 0 (a mirror) to 1
};
/// A matte base under a clear, rough coat.
struct PlasticLook {
  Vec3f color{0.34f, 0.01f, 0.01f};  ///< linear reflectance of the base, 0 to 1
  float roughness = 0.2f;            ///< of the coat, 0 (polished) to 1
};
using RenderLook = std::variant<DielectricLook, OpaqueLook, WoodLook, MetalLook, PlasticLook>;

/// The frame in which a solid texture lies: wood's fibers run along x, and its pith is off the
/// middle along z. Axes of unit length, square to each other.
struct TextureFrame {
  Vec3f middle{};  ///< m
  Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3f half{0.1f, 0.1f, 0.1f};  ///< m: how far the object reaches from its middle along each
};

/// Balls of one size, for granular and particle views. The arrays must outlive the call.
struct RenderSpheres {
  std::span<const Vec3f> positions;  ///< m
  float radius = 0.01f;              ///< m, > 0
  std::span<const Vec3f> colors;     ///< linear, one each; or empty: the look's color
};

/// A form and its look. A mesh is borrowed and must outlive the call; the mesh of a dielectric must
/// be closed, its triangles counter-clockwise seen from outside, and wall vertices exactly on the
/// basin's planes.
struct RenderObject {
  std::variant<const TriMesh*, RenderSpheres> form;
  RenderLook look;
  std::span<const Vec3f> colors{};  ///< linear, one a vertex of an opaque mesh; or empty: the look's color
  TextureFrame frame{};             ///< of wood
  /// Where clear objects overlap, the one with the higher priority is there; of one priority, the
  /// later one.
  int priority = 0;
};

/// Angles in degrees; azimuth from +x towards +z.
struct RenderCamera {
  bool fit_basin = true;               ///< from azimuth, elevation and fill; else from `from` to `to`
  float azimuth = 60, elevation = 14;  ///< where the camera stands, seen from the basin
  float fov = 34;                      ///< vertical, 1 to 150
  float fill = 0.84f;                  ///< share of the frame that the basin's corners fill, 0.05 to 2
  Vec3f from{}, to{};                  ///< m
};

struct RenderLight {
  float sun_elevation = 34, sun_azimuth = 228;  ///< degrees; elevation 2 to 90
  float sun_angle = 2.5f;                       ///< radius of the visible disc, degrees, 0.1 to 20
  float sun_strength = 8;                       ///< irradiance square to the sun; 0: no sun
  SkyKind sky = SkyKind::clear;
};

struct RenderStage {
  bool floor_tiles = true;  ///< a tiled terrace at the basin's lowest plane
  bool basin_glass = true;  ///< thin panes at the side walls, open above
};

struct RenderScene {
  Box3f basin;                                                       ///< m
  std::array<bool, 6> is_wall{true, true, true, false, true, true};  ///< x_min x_max y_min y_max z_min z_max
  std::vector<RenderObject> objects;
  RenderCamera camera;
  RenderLight light;
  RenderStage stage;
  /// m: a clear mesh that ends this near to a clear object of a higher priority is drawn as
  /// touching it. 0: as it is.
  float wetting = 0;
  bool physical = false;  ///< leave out what is only look: in-scatter, the softened sun disc, the clamp
};

struct RenderSettings {
  int width = 640, height = 360;  ///< 8 to 16384
  int samples = 32;               ///< at most, a pixel; >= min_samples
  int min_samples = 4;            ///< everywhere, >= 2
  float noise = 0.013f;           ///< tone-mapped error to stop at, > 0
  bool caustics = true;           ///< sunlight reaches the floor refracted; false: straight on, only dimmed
  std::uint64_t seed = 1;
};

/// Linear radiance, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<Vec3f> linear;
};

/// Called now and then from the calling thread with the share done, 0 to 1.
using RenderProgress = std::function<void(double)>;

/// Throws InputError naming a value that is out of range, as `render` does.
void check_render(const RenderScene& scene, const RenderSettings& settings);

/// Traces the picture; the same bytes for any number of threads. Throws InputError naming the value
/// that is out of range, RunError if Embree fails, Interrupted when asked to stop.
Image render(const RenderScene& scene, const RenderSettings& settings, const RenderProgress& progress = {});

/// Exposure, bloom, vignette and a filmic curve to 8-bit sRGB.
RgbImage tone_map(const Image& image);

/// tone_map, then an sRGB PNG, whole or absent. Throws InputError or RunError with the reason.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace dreampm
