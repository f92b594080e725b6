#include "dreampm/render/render.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/error.h"
#include "dreampm/render/camera.h"
#include "dreampm/render/denoise.h"
#include "dreampm/render/film.h"
#include "dreampm/render/integrator.h"
#include "dreampm/render/stage.h"
#include "dreampm/render/tone.h"

namespace dreampm {
namespace {

using namespace trace;

constexpr int photons = 1000000, photons_of_bodies = 400000, sky_rays = 24, sky_rays_first = 8;
constexpr int paper_bounces = 5, paper_rays_first = 24, paper_rays = 96, near_rays_first = 8, near_rays = 48;

/// Soft boxes leave no sharp shadow on the paper, which its cells could not hold.
bool lit_by_soft_boxes(const RenderScene& scene) {
  return scene.light.sky == SkyKind::studio && scene.light.environment.empty() && !(scene.light.sun.strength > 0);
}

/// Some settings are floats: what a float makes of a bound is within it, too.
void in_range(const char* what, double value, double low, double high) {
  const double least = std::min(low, double(static_cast<float>(low)));
  const double most = std::max(high, double(static_cast<float>(high)));
  if (!(value >= least && value <= most))
    fail_input("render: {} is {}; give one from {} to {}", what, value, low, high);
}

/// What spills into the pixels of `box` lies within that many of them; one more shows how noisy
/// the last of these are.
PixelBox with_surroundings(const PixelBox& box, const RenderSettings& s) {
  const int more = bloom_reach(s.height) + 1;
  return {std::max(0, box.x0 - more), std::max(0, box.y0 - more), std::min(s.width, box.x1 + more),
          std::min(s.height, box.y1 + more)};
}

void check_crop(const PixelBox& c, const RenderSettings& s) {
  if (c.x0 < 0 || c.y0 < 0 || c.x1 > s.width || c.y1 > s.height || c.x0 >= c.x1 || c.y0 >= c.y1)
    fail_input("render: the crop {},{},{},{} is no part of {} x {} pixels; give x0 < x1 and y0 < y1 within them", c.x0,
               c.y0, c.x1, c.y1, s.width, s.height);
}

void check_lens(const model::Camera& camera) {
  in_range("camera shutter", camera.shutter, 0, 1);
  in_range("camera aperture", camera.aperture, 0, 1e3);
  if (camera.fstop) in_range("camera fstop", *camera.fstop, 0.1, 1e6);
  if (camera.focus) in_range("camera focus", *camera.focus, 1e-6, 1e9);
  if (camera.focus_point && !is_finite(*camera.focus_point))
    fail_input("render: the camera's focus is not finite; give a point");
}

/// Lights the floor, by what `bounce` sees from it.
void bake(FloorLight& light, const Integrator& bounce, bool moves, const RenderSettings& settings) {
  light.bake_sun(settings.caustics, photons, settings.seed);
  const auto from = [&](const Vec3f& p, const Vec3f& d, Sampler& random) {
    const float time = moves ? random.next() : 0.5f;
    return bounce.radiance(p, d, random, time);
  };
  // twice: the second round sees the light that the floor throws back on itself
  light.bake_sky(from, sky_rays_first, settings.seed);
  light.bake_sky(from, sky_rays, settings.seed + 1);
}

/// What sees the paper whose light is baked.
struct Studio {
  const RenderScene& scene;
  const Geometry& geometry;
  const trace::Sky& sky;
  const FloorPattern& pattern;
  PathOptions options;  ///< with the light
  float scale;
};

/// Lights the paper: first empty, then what stands on it changes that.
void bake(PaperLight& light, const Studio& studio, const RenderSettings& settings) {
  RenderScene empty = studio.scene;
  empty.objects = {studio.scene.objects.back()};
  empty.stage.basin = model::Basin::none;
  const Geometry open_geometry(empty);
  PathOptions options = studio.options;
  options.looks = options.sun_disc = false;
  options.splits = 0;
  PathOptions alone = options;
  alone.paper = 0;
  const Integrator full(studio.geometry, studio.sky, studio.pattern, studio.scale, options),
      open(open_geometry, studio.sky, studio.pattern, studio.scale, alone);
  const auto by = [moves = studio.geometry.moves()](const Integrator& integrator) {
    return [&integrator, moves](const Vec3f& p, const Vec3f& n, Sampler& random) {
      const float time = moves ? random.next() : 0.5f;
      return integrator.arriving(p, n, random, time);
    };
  };
  for (int bounce = 0; bounce < paper_bounces; ++bounce)
    light.bake_open(by(open), bounce + 1 < paper_bounces ? paper_rays_first : paper_rays,
                    settings.seed + static_cast<std::uint64_t>(bounce));
  const auto lies = [&](const Vec3f& p) {
    const Vec3f up{0, 1, 0};
    const Hit hit = studio.geometry.cast(p + up * (2 * studio.geometry.epsilon()), up, air, 0.5f);
    if (!hit.back) return PaperLight::Over::nothing;
    return hit.kind == Kind::dielectric ? PaperLight::Over::clear
           : hit.kind == Kind::opaque   ? PaperLight::Over::opaque
                                        : PaperLight::Over::nothing;
  };
  for (int bounce = 0; bounce < 2; ++bounce)
    light.bake_near(studio.scene.basin, by(full), by(open), lies, bounce == 0 ? near_rays_first : near_rays,
                    settings.seed + static_cast<std::uint64_t>(bounce));
}

Picture exposed(const RenderSettings& settings, const Film::View& view, bool clamp, const RenderProgress& report) {
  Picture out;
  out.width = settings.width, out.height = settings.height;
  out.box = settings.crop.value_or(PixelBox{0, 0, settings.width, settings.height});
  out.traced = with_surroundings(out.box, settings);
  Film film(settings, out.traced, view, clamp);
  film.expose([&](double done) { report(0.2 + 0.4 * done); });
  film.ask_more();
  film.expose([&](double done) { report(0.6 + 0.4 * done); });
  out.linear = film.linear();
  out.report = film.report(out.box);
  if (view.firsts != nullptr) out.surfaces = film.surfaces();
  if (settings.denoise)
    denoise(out.linear, out.surfaces.albedo, out.surfaces.normal, out.traced.width(), out.traced.height());
  if (!settings.surfaces) out.surfaces = {};
  return out;
}

/// All but the files.
void check_values(const RenderScene& scene, const RenderSettings& s) {
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
  check_lens(scene.camera);
  in_range("frame time", scene.frame_time, 1e-9, 1e9);
  if (s.crop) check_crop(*s.crop, s);
  in_range("sun elevation", scene.light.sun.elevation, 2, 90);
  in_range("sun azimuth", scene.light.sun.azimuth, -3600, 3600);
  in_range("sun angle", scene.light.sun.angle, 0.1, 20);
  in_range("sun strength", scene.light.sun.strength, 0, 1e6);
  if (!scene.light.environment.empty()) in_range("environment strength", scene.light.strength, 1e-6, 1e6);
  in_range("environment turn", scene.light.turn, -3600, 3600);
  const Box3f& b = scene.basin;
  if (!is_finite(b.min) || !is_finite(b.max) || !(b.size().x > 0 && b.size().y > 0 && b.size().z > 0))
    fail_input("render: the basin from ({}, {}, {}) to ({}, {}, {}) has no volume; give min below max", b.min.x,
               b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
  for (const RenderObject& o : scene.objects) {
    if (const auto* mesh = std::get_if<const TriMesh*>(&o.form); mesh != nullptr && *mesh == nullptr)
      fail_input("render: an object has no mesh");
    const model::Look& look = o.look;
    if (look.type == model::LookType::dielectric) {
      in_range("ior", look.ior, 1, 3);
      for (int k = 0; k < 3; ++k) in_range("absorption", look.absorption[k], 0, 1e6);
      for (int k = 0; k < 3; ++k) in_range("scattering", look.scattering[k], 0, 1e6);
      in_range("anisotropy", look.anisotropy, -0.95, 0.95);
      continue;
    }
    in_range("roughness", look.roughness, 0, 1);
    in_range("ring", look.ring.value_or(0), 0, 100);
    for (int k = 0; k < 3; ++k) in_range("color", look.color[k], 0, 1);
  }
  const trace::Camera sees_its_focus(scene.camera, scene.basin, s.width, s.height);
}

}  // namespace

void check_render(const RenderScene& scene, const RenderSettings& settings) {
  check_values(scene, settings);
  if (!scene.light.environment.empty()) trace::read_environment(scene.light);
}

Picture render_picture(const RenderScene& scene, const RenderSettings& settings, const RenderProgress& progress) {
  check_values(scene, settings);
  const auto report = [&](double done) {
    if (progress) progress(done);
  };
  const trace::Camera camera(scene.camera, scene.basin, settings.width, settings.height);
  RenderScene staged = scene;
  const std::optional<Backdrop> backdrop = backdrop_of(scene, camera.eye());
  const TriMesh paper = backdrop ? backdrop->mesh() : TriMesh{};
  if (backdrop) staged.objects.push_back({&paper, paper_look(), {}});
  const Geometry geometry(staged);
  const trace::Sky sky(scene.light, scene.physical);
  const FloorPattern pattern(scene.basin, scene.stage.place);
  const Lamps lamps = lamps_of(scene);
  const float scale = std::max(scene.basin.size().x, scene.basin.size().z);
  // Small lights are found by aiming at them, which a floor without baked light does.
  const bool baked = sky.aimed_at() == nullptr && lamps.empty();
  FloorLight light(geometry, sky, scene.basin);
  PathOptions options;
  options.physical = scene.physical;
  options.pixel_angle = camera.pixel_angle();
  if (baked) options.floor_light = &light;
  if (!lamps.empty()) options.lamps = &lamps;
  const Box3f clear = clear_bounds(scene, geometry);
  std::optional<PhotonMap> caustics;
  if (settings.caustics && !clear.empty() && (!baked || has_matte(scene, geometry)))
    options.photons =
        &caustics.emplace(geometry, sky, lamps, clear, !baked, baked ? photons_of_bodies : photons, settings.seed);
  if (baked && scene.stage.floor == model::Floor::tiles) {
    PathOptions gather = options;
    gather.looks = gather.sun_disc = false;
    gather.splits = 0;
    gather.pixel_angle = 0.02f;
    bake(light, Integrator(geometry, sky, pattern, scale, gather), geometry.moves(), settings);
  }
  std::optional<PaperLight> paper_light;
  if (backdrop && lit_by_soft_boxes(scene)) {
    options.paper_light = &paper_light.emplace(*backdrop);
    options.paper = geometry.objects() - 1;
    bake(*paper_light, {staged, geometry, sky, pattern, options, scale}, settings);
  }
  report(0.2);
  const Integrator integrator(geometry, sky, pattern, scale, options);
  const FirstHits firsts(geometry, sky, pattern, camera.pixel_angle());
  Film::View view{integrator, camera, nullptr, geometry.moves(), scene.frame_time};
  if (settings.denoise || settings.surfaces) view.firsts = &firsts;
  return exposed(settings, view, !scene.physical, report);
}

Image render(const RenderScene& scene, const RenderSettings& settings, const RenderProgress& progress) {
  if (settings.crop) fail_input("render: a part was asked for where the whole picture is given");
  Picture picture = render_picture(scene, settings, progress);
  return {picture.width, picture.height, std::move(picture.linear)};
}

}  // namespace dreampm
