// Pictures of a frame: water, opaque meshes and spheres in an open glass basin on a tiled floor,
// under sun and sky. A path tracer over Embree; the floor's light is baked first, so that caustics
// come with it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "dreampm/geometry/mesh.h"
#include "dreampm/io/exr.h"
#include "dreampm/io/png.h"
#include "dreampm/math/vec.h"
#include "dreampm/model/render.h"
#include "dreampm/render/absorption.h"

namespace dreampm {

/// The frame in which a solid texture lies: wood's fibers run along x, and its pith is off the
/// middle along z. Axes of unit length, square to each other.
struct TextureFrame {
  Vec3f middle{};  ///< m
  Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3f half{0.1f, 0.1f, 0.1f};  ///< m: how far the object reaches from its middle along each
};

/// Balls of one size, for granular and particle views. The arrays must outlive the call.
struct RenderSpheres {
  std::span<const Vec3f> positions;     ///< m
  float radius = 0.01f;                 ///< m, > 0
  std::span<const Vec3f> colors;        ///< linear, one each; or empty: the look's color
  std::span<const Vec3f> velocities{};  ///< m/s, one each; or empty: at rest
};

/// Balls too small to be seen one by one, as drops and bubbles of foam: matte, and lit as the mean
/// over a ball where they are smaller than a pixel. The arrays must outlive the call.
struct RenderGrains {
  std::span<const Vec3f> positions;     ///< m
  std::span<const float> radii;         ///< m, one each, > 0; of those below a pixel about half of it
  std::span<const float> opacity;       ///< the share of its disc that each covers, one each, 0 to 1
  std::span<const Vec3f> colors;        ///< linear reflectance, one each
  std::span<const Vec3f> velocities{};  ///< m/s, one each; or empty: at rest
};

/// A form and its look. A mesh is borrowed and must outlive the call; the mesh of a dielectric must
/// be closed, its triangles counter-clockwise seen from outside, and wall vertices exactly on the
/// basin's planes.
struct RenderObject {
  std::variant<const TriMesh*, RenderSpheres, RenderGrains> form;
  model::Look look;
  std::span<const Vec3f> colors{};  ///< linear, one a vertex of an opaque mesh; or empty: the look's color
  TextureFrame frame{};             ///< of wood
  /// Where clear objects overlap, the one with the higher priority is there; of one priority, the
  /// later one.
  int priority = 0;
  /// The mesh at even steps through the exposure, from its beginning to its end, of the same
  /// triangles; borrowed, too. Empty: its vertices go straight on with its velocities.
  std::vector<const TriMesh*> motion{};
  /// Of clear matter of several colors, in place of its look's absorption; borrowed, too. Cloudy
  /// matter has none.
  const AbsorptionField* absorption = nullptr;
};

struct RenderScene {
  Box3f basin;                                                       ///< m
  std::array<bool, 6> is_wall{true, true, true, false, true, true};  ///< x_min x_max y_min y_max z_min z_max
  std::vector<RenderObject> objects;
  model::Camera camera;
  model::Light light;
  model::SceneProps stage;
  double frame_time = 1.0 / 24;  ///< s, from frame to frame, > 0
  bool physical = false;         ///< leave out what is only look: in-scatter, the softened sun disc, the clamp
};

/// Pixels from (x0, y0) to (x1, y1), these not included, from the upper left.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  std::size_t size() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
  bool operator==(const PixelBox&) const = default;
};

struct RenderSettings {
  int width = 640, height = 360;  ///< 8 to 16384
  int samples = 32;               ///< at most, a pixel; >= min_samples
  int min_samples = 4;            ///< everywhere, >= 2
  float noise = 0.013f;           ///< tone-mapped error to stop at, > 0
  bool caustics = true;           ///< sunlight reaches the floor refracted; false: straight on, only dimmed
  std::uint64_t seed = 1;
  std::optional<PixelBox> crop{};  ///< draw only that part; its pixels are those of the whole picture
  bool denoise = false;            ///< needs Open Image Denoise, which is looked for when it runs
  bool surfaces = false;           ///< keep what the first surfaces are like, too
};

/// What the first surfaces are like that pixels see, row by row from the top.
struct FirstSurfaces {
  std::vector<float> depth;                  ///< m along the line of sight, at the pixel's middle; sky_depth: none
  std::vector<std::array<float, 2>> motion;  ///< pixels from frame to frame, to the right and up, there
  std::vector<Vec3f> normal;                 ///< in the scene's axes, towards the camera; mean over the pixel
  /// Reflectance, mean over the pixel; through clear surfaces that of what lies behind them.
  std::vector<Vec3f> albedo;
};
inline constexpr float sky_depth = 1e10f;

/// How it went.
struct RenderReport {
  double samples = 0;   ///< a pixel, in the mean
  double error = 0;     ///< root mean square over pixels of the standard error as shown, as RenderSettings::noise
  double at_limit = 0;  ///< the share of pixels that stopped at the most samples with a larger error than asked for
};

struct Picture {
  int width = 0, height = 0;  ///< of the whole frame
  PixelBox box;               ///< what was asked for
  PixelBox traced;            ///< the same with what spills light into it
  std::vector<Vec3f> linear;  ///< radiance of the pixels of `traced`, row by row from the top
  FirstSurfaces surfaces;     ///< of `traced`; empty unless asked for
  RenderReport report;
};

/// Called now and then from the calling thread with the share done, 0 to 1.
using RenderProgress = std::function<void(double)>;

/// Throws InputError naming a value that is out of range, or what is wrong with the environment's
/// file, as `render` does.
void check_render(const RenderScene& scene, const RenderSettings& settings);

/// Traces the picture; the same bytes for any number of threads. Throws InputError naming the value
/// that is out of range, RunError if Embree fails, Interrupted when asked to stop.
Picture render_picture(const RenderScene& scene, const RenderSettings& settings, const RenderProgress& progress = {});
/// The radiance of the same, of the whole frame.
Image render(const RenderScene& scene, const RenderSettings& settings, const RenderProgress& progress = {});

/// Exposure, bloom, vignette and a filmic curve to 8-bit sRGB.
RgbImage tone_map(const Image& image);
/// The same of what was asked for.
RgbImage tone_map(const Picture& picture);

/// tone_map, then an sRGB PNG, whole or absent. Throws InputError or RunError with the reason.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace dreampm
