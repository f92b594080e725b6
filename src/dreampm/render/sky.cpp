#include "dreampm/render/sky.h"

#include <array>
#include <cstddef>

#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/exr.h"
#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

constexpr float sky_gain = 0.8f;
const Vec3f horizon{0.62f, 0.78f, 1.0f}, middle{0.16f, 0.40f, 0.85f}, zenith{0.03f, 0.12f, 0.45f};
const Vec3f sun_color{1.0f, 0.88f, 0.70f}, glow_color{1.0f, 0.86f, 0.62f};
/// Radiance of the disc in reflections where looks may win over truth: bright enough to glint,
/// without fireflies.
constexpr float soft_disc = 90;
/// The share of the disc that casts shadows then: crisp caustics.
constexpr float soft_shadow = 0.35f;

/// An environment throws caustics where it is brighter than its mean by this factor.
constexpr float bright_times = 3;

/// Soft clouds on a flat layer, thinning to the horizon: cover in x, shade in y.
std::pair<float, float> clouds(const Vec3f& d) {
  float x = 1.1f * d.x / (d.y + 0.12f) + 3.1f, z = 1.1f * d.z / (d.y + 0.12f) + 7.7f, sum = 0, weight = 0.5f;
  for (int octave = 0; octave < 5; ++octave) {
    sum += weight * value_noise(x, z);
    x = 2.03f * x + 1.7f, z = 2.03f * z + 9.2f, weight *= 0.5f;
  }
  return {smoothstep(0.47f, 0.72f, sum) * smoothstep(0.02f, 0.22f, d.y), 1.15f - 0.35f * smoothstep(0.5f, 0.9f, sum)};
}

/// A soft box: a rectangle of light, seen from the middle of the room.
struct SoftBox {
  Vec3f towards;     ///< its middle
  float wide, high;  ///< half of its sides over its distance
  Vec3f radiance;
};

/// Soft boxes in a gray room: a large one as the key, a strip to the side, one above, and a narrow
/// one behind for the rims.
Environment studio_boxes() {
  static const std::array<SoftBox, 4> boxes{{{{-0.70f, 0.75f, 0.55f}, 0.42f, 0.42f, {3.3f, 3.15f, 2.95f}},
                                             {{0.85f, 0.35f, 0.75f}, 0.14f, 0.60f, {2.1f, 2.3f, 2.6f}},
                                             {{0.05f, 1.0f, 0.0f}, 0.60f, 0.35f, {1.7f, 1.7f, 1.7f}},
                                             {{0.55f, 0.50f, -0.85f}, 0.45f, 0.10f, {3.4f, 3.6f, 3.9f}}}};
  constexpr int width = 1024, height = 512;
  std::vector<Vec3f> pixels(static_cast<std::size_t>(width) * height);
  parallel_for(height, 8, [&](std::size_t y) {
    const float theta = pi * (static_cast<float>(y) + 0.5f) / height;
    for (int x = 0; x < width; ++x) {
      const float phi = 2 * pi * ((static_cast<float>(x) + 0.5f) / width - 0.5f);
      const Vec3f d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
      // the room: lighter towards its floor
      Vec3f c = mix(Vec3f{0.34f, 0.34f, 0.35f}, Vec3f{0.06f, 0.063f, 0.07f}, smoothstep(-0.1f, 0.8f, d.y));
      for (const SoftBox& box : boxes) {
        const Vec3f n = normalized(box.towards),
                    side = normalized(cross(std::fabs(n.y) < 0.95f ? Vec3f{0, 1, 0} : Vec3f{0, 0, 1}, n)),
                    up = cross(n, side);
        const float far = dot(d, n);
        if (far <= 0) continue;
        const float u = std::fabs(dot(d, side) / far) / box.wide, v = std::fabs(dot(d, up) / far) / box.high;
        const float lit = (1 - smoothstep(0.94f, 1.02f, u)) * (1 - smoothstep(0.94f, 1.02f, v));
        c = mix(c, box.radiance * (1.1f - 0.25f * (u * u + v * v)), lit);
      }
      pixels[y * width + static_cast<std::size_t>(x)] = c;
    }
  });
  return {width, height, std::move(pixels)};
}

/// What a moonless sky over a town leaves.
Vec3f night(const Vec3f& d) {
  return mix(Vec3f{0.020f, 0.022f, 0.034f}, Vec3f{0.003f, 0.005f, 0.013f}, smoothstep(0, 0.6f, d.y));
}

}  // namespace

Environment read_environment(const model::Light& light) try {
  Image image = read_exr_colors(light.environment);
  if (image.width != 2 * image.height)
    fail_input("{}: {} x {} pixels; an environment is twice as wide as high: longitude across, latitude down",
               light.environment, image.width, image.height);
  const auto strength = static_cast<float>(light.strength);
  double sum = 0;
  for (Vec3f& c : image.linear) {
    c = max(c, Vec3f{}) * strength;  // resampling leaves little negative ones
    sum += static_cast<double>(luminance(c));
  }
  if (!(sum > 0)) fail_input("{}: black all over; an environment has light", light.environment);
  return {image.width, image.height, std::move(image.linear), static_cast<float>(light.turn) * degree};
} catch (const InputError& e) {
  fail_input("render.light.environment: {}", e.what());
}

Sky::Sky(const model::Light& light, bool physical) : kind_(light.sky), has_sun_(light.sun.strength > 0) {
  const auto strength = static_cast<float>(light.sun.strength);
  const float elevation = static_cast<float>(light.sun.elevation) * degree,
              azimuth = static_cast<float>(light.sun.azimuth) * degree;
  sun_ = {std::cos(elevation) * std::cos(azimuth), std::sin(elevation), std::cos(elevation) * std::sin(azimuth)};
  sun_irradiance_ = sun_color * strength;
  disc_angle_ = static_cast<float>(light.sun.angle) * degree;
  disc_cos_ = std::cos((physical ? 1.0f : 1.25f) * disc_angle_);
  shadow_tan_ = std::tan(disc_angle_ * (physical ? 1.0f : soft_shadow));
  const float solid_angle = 2 * pi * (1 - std::cos(disc_angle_));
  disc_radiance_ = physical ? sun_irradiance_ * (1 / solid_angle) : sun_color * (soft_disc * strength / 8);
  if (physical) disc_angle_ = -disc_angle_;  // a hard edge
  if (!light.environment.empty())
    environment_ = read_environment(light);
  else if (kind_ == SkyKind::studio)
    environment_ = studio_boxes();
  else if (kind_ != SkyKind::uniform)
    fill_table();
  if (environment_) {
    bright_ = environment_->bright_parts(bright_times);
    open_ = environment_->irradiance({0, 1, 0});
    return;
  }
  const int n = 64;
  const Frame ground({0, 1, 0});
  Vec3d sum;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      sum += static_cast<Vec3d>(without_sun(
          cosine_direction(ground, (static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n)));
  open_ = static_cast<Vec3f>(sum * (std::numbers::pi / (n * n)));
}

void Sky::fill_table() {
  table_.resize(static_cast<std::size_t>(columns) * rows);
  parallel_for(rows, 4, [&](std::size_t y) {
    const float v = (static_cast<float>(y) + 0.5f) / rows, up = v * v, side = std::sqrt(std::max(0.0f, 1 - up * up));
    for (int x = 0; x < columns; ++x) {
      const float a = 2 * pi * ((static_cast<float>(x) + 0.5f) / columns - 0.5f);
      const Vec3f d{side * std::cos(a), up, side * std::sin(a)};
      table_[y * columns + static_cast<std::size_t>(x)] = kind_ == SkyKind::clear ? clear(d) : night(d);
    }
  });
}

Vec3f Sky::clear(const Vec3f& d) const {
  const float y = std::max(d.y, 0.0f);
  Vec3f c = mix(mix(horizon, middle, smoothstep(0, 1, std::pow(y / (y + 0.14f), 0.8f))), zenith,
                smoothstep(0, 1, std::pow(y, 0.7f)));
  const float k = std::max(0.0f, dot(d, sun_));
  if (has_sun_) c += glow_color * (0.6f * std::pow(k, 5.0f) + 1.2f * std::pow(k, 60.0f));
  if (y > 0.01f) {
    const auto [cover, shade] = clouds(d);
    c = mix(c, Vec3f{1.25f, 1.24f, 1.22f} * shade, 0.8f * cover);
  }
  return c * sky_gain;
}

Vec3f Sky::without_sun(const Vec3f& d) const {
  if (environment_) return environment_->radiance(d);
  if (kind_ == SkyKind::uniform) return {1, 1, 1};
  float u = (std::atan2(d.z, d.x) / (2 * pi) + 0.5f) * columns - 0.5f;
  if (u < 0) u += columns;
  const float v = std::clamp(std::sqrt(std::max(0.0f, d.y)) * rows - 0.5f, 0.0f, rows - 1.001f);
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const Vec3f* low = &table_[static_cast<std::size_t>(y) * columns];
  const Vec3f* high = low + columns;
  const int x0 = x % columns, x1 = (x + 1) % columns;
  const float fx = u - static_cast<float>(x);
  return mix(mix(low[x0], low[x1], fx), mix(high[x0], high[x1], fx), v - static_cast<float>(y));
}

Vec3f Sky::radiance(const Vec3f& d, bool with_sun) const {
  Vec3f c = without_sun(d);
  if (with_sun && has_sun_) {
    const float k = dot(d, sun_);
    if (k > disc_cos_) {
      const float edge =
          disc_angle_ < 0 ? 1 : 1 - smoothstep(0.75f * disc_angle_, 1.25f * disc_angle_, std::acos(std::min(1.0f, k)));
      c += disc_radiance_ * edge;
    }
  }
  return c;
}

Vec3f Sky::sample_sun(float a, float b) const {
  const float r = std::sqrt(a) * shadow_tan_, phi = 2 * pi * b;
  const Frame frame(sun_);
  return normalized(frame.world(r * std::cos(phi), r * std::sin(phi), 1));
}

}  // namespace dreampm::trace
