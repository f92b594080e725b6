#include "dreampm/render/render.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/base/interrupt.h"
#include "dreampm/base/parallel.h"
#include "dreampm/render/camera.h"
#include "dreampm/render/integrator.h"
#include "dreampm/render/tone.h"

namespace dreampm {
namespace {

using namespace trace;

constexpr int photons = 1000000, sky_rays = 24, sky_rays_first = 8;
constexpr int tile = 16;
/// Brighter samples are fireflies.
constexpr float brightest = 10;

/// Some settings are floats: what a float makes of a bound is within it, too.
void in_range(const char* what, double value, double low, double high) {
  const double least = std::min(low, double(static_cast<float>(low)));
  const double most = std::max(high, double(static_cast<float>(high)));
  if (!(value >= least && value <= most))
    fail_input("render: {} is {}; give one from {} to {}", what, value, low, high);
}

/// Samples of one pixel so far.
struct Pixel {
  Vec3f sum;
  float shown = 0, shown2 = 0;  ///< of the lightness as shown, and its square
  int count = 0;
};

/// A tent filter a bit narrower than a pixel each way.
float tent(float u) { return 0.9f * (u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u)); }

class Film {
 public:
  Film(const RenderSettings& settings, bool clamp)
      : settings_(settings),
        clamp_(clamp),
        width_(static_cast<std::size_t>(settings.width)),
        height_(static_cast<std::size_t>(settings.height)),
        pixels_(width_ * height_),
        wanted_(width_ * height_, settings.min_samples) {}

  /// Brings every pixel to its wanted number of samples.
  void expose(const Integrator& integrator, const trace::Camera& camera, const std::function<void(double)>& progress) {
    const std::size_t across = (width_ + tile - 1) / tile, down = (height_ + tile - 1) / tile;
    constexpr std::size_t band = 4;
    for (std::size_t row = 0; row < down; row += band) {
      if (interrupted()) throw Interrupted("interrupted while rendering");
      const std::size_t rows = std::min(band, down - row);
      parallel_for(across * rows, 1,
                   [&](std::size_t i) { expose_tile(integrator, camera, i % across, row + i / across); });
      progress(static_cast<double>(row + rows) / static_cast<double>(down));
    }
  }

  /// Asks for more samples where the error as shown, of the pixel or a neighbor, is above the
  /// noise asked for.
  void ask_more() {
    std::vector<float> error(pixels_.size());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const Pixel& p = pixels_[i];
      const float n = static_cast<float>(p.count), mean = p.shown / n;
      error[i] = std::sqrt(std::max(0.0f, p.shown2 / n - mean * mean) / (n - 1));
    }
    for (std::size_t y = 0; y < height_; ++y)
      for (std::size_t x = 0; x < width_; ++x) {
        float worst = error[y * width_ + x];
        for (std::size_t yy = y > 0 ? y - 1 : 0; yy < std::min(y + 2, height_); ++yy)
          for (std::size_t xx = x > 0 ? x - 1 : 0; xx < std::min(x + 2, width_); ++xx)
            worst = std::max(worst, 0.7f * error[yy * width_ + xx]);
        const float k = worst / settings_.noise, n = static_cast<float>(settings_.min_samples) * k * k;
        wanted_[y * width_ + x] = static_cast<int>(
            std::clamp(n, static_cast<float>(settings_.min_samples), static_cast<float>(settings_.samples)));
      }
  }

  Image image() const {
    Image out{settings_.width, settings_.height, std::vector<Vec3f>(pixels_.size())};
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      out.linear[i] = pixels_[i].sum * (1 / static_cast<float>(pixels_[i].count));
    return out;
  }

 private:
  void expose_tile(const Integrator& integrator, const trace::Camera& camera, std::size_t tx, std::size_t ty) {
    for (std::size_t y = ty * tile; y < std::min(height_, (ty + 1) * tile); ++y)
      for (std::size_t x = tx * tile; x < std::min(width_, (tx + 1) * tile); ++x) {
        const std::size_t i = y * width_ + x;
        Pixel& pixel = pixels_[i];
        for (; pixel.count < wanted_[i]; ++pixel.count) {
          Sampler random(stream_of(settings_.seed, 0, static_cast<std::uint32_t>(i)),
                         static_cast<std::uint32_t>(pixel.count));
          const float a = random.next(), b = random.next();
          Vec3f c = integrator.radiance(
              camera.eye(),
              camera.direction(static_cast<float>(x) + 0.5f + tent(a), static_cast<float>(y) + 0.5f + tent(b)), random);
          if (!is_finite(c)) c = {};
          if (const float m = largest(c); clamp_ && m > brightest) c *= brightest / m;
          const float shown = shown_lightness(c);
          pixel.sum += c, pixel.shown += shown, pixel.shown2 += shown * shown;
        }
      }
  }

  RenderSettings settings_;
  bool clamp_;
  std::size_t width_, height_;
  std::vector<Pixel> pixels_;
  std::vector<int> wanted_;
};

}  // namespace

void check_render(const RenderScene& scene, const RenderSettings& s) {
  in_range("width", s.width, 8, 16384);
  in_range("height", s.height, 8, 16384);
  in_range("min_samples", s.min_samples, 2, 65536);
  in_range("samples", s.samples, s.min_samples, 65536);
  in_range("noise", s.noise, 1e-6, 1e6);
  in_range("camera fov", scene.camera.fov, 1, 150);
  if (scene.camera.fit_basin) {
    in_range("camera azimuth", scene.camera.azimuth, -3600, 3600);
    in_range("camera elevation", scene.camera.elevation, -89, 90);
    in_range("camera fill", scene.camera.fill, 0.05, 2);
  } else if (!is_finite(scene.camera.from) || !is_finite(scene.camera.to) ||
             length(scene.camera.to - scene.camera.from) <= 0) {
    fail_input("render: the camera's `from` and `to` are the same point or not finite; give two points");
  }
  in_range("sun elevation", scene.light.sun.elevation, 2, 90);
  in_range("sun azimuth", scene.light.sun.azimuth, -3600, 3600);
  in_range("sun angle", scene.light.sun.angle, 0.1, 20);
  in_range("sun strength", scene.light.sun.strength, 0, 1e6);
  const Box3f& b = scene.basin;
  if (!is_finite(b.min) || !is_finite(b.max) || !(b.size().x > 0 && b.size().y > 0 && b.size().z > 0))
    fail_input("render: the basin from ({}, {}, {}) to ({}, {}, {}) has no volume; give min below max", b.min.x,
               b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
  for (const RenderObject& o : scene.objects) {
    if (const auto* mesh = std::get_if<const TriMesh*>(&o.form); mesh != nullptr && *mesh == nullptr)
      fail_input("render: an object has no mesh");
    const model::Look& look = o.look;
    if (look.type == model::LookType::dielectric) {
      in_range("ior", look.ior, 1.01, 3);
      for (int k = 0; k < 3; ++k) in_range("absorption", look.absorption[k], 0, 1e6);
      continue;
    }
    in_range("roughness", look.roughness, 0, 1);
    in_range("ring", look.ring.value_or(0), 0, 100);
    for (int k = 0; k < 3; ++k) in_range("color", look.color[k], 0, 1);
  }
}

Image render(const RenderScene& scene, const RenderSettings& settings, const RenderProgress& progress) {
  check_render(scene, settings);
  const auto report = [&](double done) {
    if (progress) progress(done);
  };
  const Geometry geometry(scene);
  const trace::Sky sky(scene.light, scene.physical);
  const FloorPattern pattern(scene.basin);
  const trace::Camera camera(scene.camera, scene.basin, settings.width, settings.height);
  const float scale = std::max(scene.basin.size().x, scene.basin.size().z);
  FloorLight light(geometry, sky, scene.basin);
  if (scene.stage.floor == model::Floor::tiles) {
    light.bake_sun(settings.caustics, photons, settings.seed);
    PathOptions gather;
    gather.floor_light = &light;
    gather.physical = scene.physical;
    gather.looks = gather.sun_disc = false;
    gather.splits = 0;
    gather.pixel_angle = 0.02f;
    const Integrator bounce(geometry, sky, pattern, scale, gather);
    const auto from = [&](const Vec3f& p, const Vec3f& d, Sampler& random) { return bounce.radiance(p, d, random); };
    // twice: the second round sees the light that the floor throws back on itself
    light.bake_sky(from, sky_rays_first, settings.seed);
    light.bake_sky(from, sky_rays, settings.seed + 1);
  }
  report(0.2);
  PathOptions options;
  options.floor_light = &light;
  options.physical = scene.physical;
  options.pixel_angle = camera.pixel_angle();
  const Integrator integrator(geometry, sky, pattern, scale, options);
  Film film(settings, !scene.physical);
  film.expose(integrator, camera, [&](double done) { report(0.2 + 0.4 * done); });
  film.ask_more();
  film.expose(integrator, camera, [&](double done) { report(0.6 + 0.4 * done); });
  return film.image();
}

}  // namespace dreampm
