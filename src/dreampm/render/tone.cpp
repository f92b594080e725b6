#include "dreampm/render/tone.h"

#include <cstddef>

#include "dreampm/base/parallel.h"
#include "dreampm/math/srgb.h"
#include "dreampm/render/blur.h"
#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

constexpr float exposure = 0.80f, vignette = 0.16f, bloom = 0.06f, bloom_from = 1.6f;
constexpr float toe = 0.15f, toe_below = 0.25f, shoulder = 0.76f, shoulder_slope = 0.55f, saturation = 1.12f;
/// How much the curve works on each channel alone: the rest keeps the hue of bright colors.
constexpr float per_channel = 0.65f;

float roll_off(float x) {
  constexpr float room = 1 - shoulder;
  return x < shoulder ? x : shoulder + room * (1 - std::exp(-shoulder_slope * (x - shoulder) / room));
}

float transfer(float x) { return srgb_from_linear(std::clamp(x, 0.0f, 1.0f)); }

/// The width of the halo round bright pixels [pixels].
float bloom_width(int height) { return std::clamp(static_cast<float>(height) / 90, 0.5f, 12.0f); }

}  // namespace

Vec3f develop(Vec3f c) {
  c *= std::min(1.0f, std::pow(std::max(1e-5f, luminance(c)) / toe_below, toe));
  const float m = std::max(1e-5f, largest(c));
  c = mix(c * (roll_off(m) / m), Vec3f{roll_off(c.x), roll_off(c.y), roll_off(c.z)}, per_channel);
  const float l = luminance(c);
  c = Vec3f{l, l, l} + (c - Vec3f{l, l, l}) * saturation;
  return {transfer(c.x), transfer(c.y), transfer(c.z)};
}

Vec3f as_shown(const Vec3f& c) {
  const auto one = [](float radiance) {
    const float x = exposure * std::max(0.0f, radiance);
    return x / (x + 0.7f);
  };
  return {one(c.x), one(c.y), one(c.z)};
}

int bloom_reach(int height) { return blur_reach(bloom_width(height)); }

namespace {

/// Shows the pixels of `box`, of which those of `traced` are known in a frame of width x height.
RgbImage shown(const std::vector<Vec3f>& linear, int width, int height, const PixelBox& traced, const PixelBox& box) {
  std::vector<Vec3f> halo(linear.size());
  bool any = false;
  for (std::size_t i = 0; i < halo.size(); ++i)
    if (const float m = largest(linear[i]); m > bloom_from) halo[i] = linear[i] * ((m - bloom_from) / m), any = true;
  if (any) blur(halo, traced.width(), traced.height(), bloom_width(height));
  RgbImage out(box.width(), box.height());
  parallel_for(static_cast<std::size_t>(box.height()), 8, [&](std::size_t row) {
    const int y = box.y0 + static_cast<int>(row);
    for (int x = box.x0; x < box.x1; ++x) {
      const std::size_t i = static_cast<std::size_t>(y - traced.y0) * static_cast<std::size_t>(traced.width()) +
                            static_cast<std::size_t>(x - traced.x0);
      const float u = 2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 1;
      const float v = 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 1;
      const Vec3f c =
          develop((linear[i] + halo[i] * (2 * bloom)) * (exposure * (1 - vignette * (0.6f * u * u + 0.4f * v * v))));
      // a touch of noise breaks the bands that 8 bits leave in the sky
      const auto place = static_cast<std::uint32_t>(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                                    static_cast<std::size_t>(x));
      const float dither = unit_float(hash32(place + 1)) - 0.5f;
      std::uint8_t* const pixel = out.at(x - box.x0, y - box.y0);
      for (int k = 0; k < 3; ++k)
        pixel[k] = static_cast<std::uint8_t>(std::clamp(255 * c[k] + 0.5f + dither, 0.0f, 255.0f));
    }
  });
  return out;
}

}  // namespace
}  // namespace dreampm::trace

namespace dreampm {

RgbImage tone_map(const Image& image) {
  const PixelBox all{0, 0, image.width, image.height};
  return trace::shown(image.linear, image.width, image.height, all, all);
}

RgbImage tone_map(const Picture& p) { return trace::shown(p.linear, p.width, p.height, p.traced, p.box); }

void write_png(const std::filesystem::path& path, const Image& image) { write_png(path, tone_map(image)); }

}  // namespace dreampm
