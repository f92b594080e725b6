#include "dreampm/render/tone.h"

#include <cstddef>

#include "dreampm/base/parallel.h"
#include "dreampm/math/srgb.h"
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

/// A separable Gaussian, edges repeated.
void blur(std::vector<Vec3f>& pixels, int width, int height, float sigma) {
  const int reach = static_cast<int>(std::ceil(2.5f * sigma));
  std::vector<float> weight(static_cast<std::size_t>(reach) + 1);
  float sum = 0;
  for (int i = 0; i <= reach; ++i) {
    const float x = static_cast<float>(i) / sigma;
    sum += (i > 0 ? 2 : 1) * (weight[static_cast<std::size_t>(i)] = std::exp(-0.5f * x * x));
  }
  for (float& w : weight) w /= sum;
  std::vector<Vec3f> half(pixels.size());
  const auto pass = [&](const std::vector<Vec3f>& in, std::vector<Vec3f>& out, bool across) {
    parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < width; ++x) {
        Vec3f c;
        for (int i = -reach; i <= reach; ++i) {
          const int xx = across ? std::clamp(x + i, 0, width - 1) : x,
                    yy = across ? y : std::clamp(y + i, 0, height - 1);
          c += in[static_cast<std::size_t>(yy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(xx)] *
               weight[static_cast<std::size_t>(std::abs(i))];
        }
        out[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = c;
      }
    });
  };
  pass(pixels, half, true);
  pass(half, pixels, false);
}

}  // namespace

Vec3f develop(Vec3f c) {
  c *= std::min(1.0f, std::pow(std::max(1e-5f, luminance(c)) / toe_below, toe));
  const float m = std::max(1e-5f, largest(c));
  c = mix(c * (roll_off(m) / m), Vec3f{roll_off(c.x), roll_off(c.y), roll_off(c.z)}, per_channel);
  const float l = luminance(c);
  c = Vec3f{l, l, l} + (c - Vec3f{l, l, l}) * saturation;
  return {transfer(c.x), transfer(c.y), transfer(c.z)};
}

float shown_lightness(const Vec3f& c) {
  const float x = exposure * luminance(c);
  return x / (x + 0.7f);
}

}  // namespace dreampm::trace

namespace dreampm {

RgbImage tone_map(const Image& image) {
  using namespace trace;
  const std::size_t width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<Vec3f> halo(image.linear.size());
  bool any = false;
  for (std::size_t i = 0; i < halo.size(); ++i)
    if (const float m = largest(image.linear[i]); m > bloom_from)
      halo[i] = image.linear[i] * ((m - bloom_from) / m), any = true;
  if (any) blur(halo, image.width, image.height, std::clamp(static_cast<float>(image.height) / 90, 0.5f, 12.0f));
  RgbImage out(image.width, image.height);
  parallel_for(height, 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      const float u = 2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 1;
      const float v = 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 1;
      const Vec3f c = develop((image.linear[i] + halo[i] * (2 * bloom)) *
                              (exposure * (1 - vignette * (0.6f * u * u + 0.4f * v * v))));
      // a touch of noise breaks the bands that 8 bits leave in the sky
      const float dither = unit_float(hash32(static_cast<std::uint32_t>(i) + 1)) - 0.5f;
      for (int k = 0; k < 3; ++k)
        out.pixels[3 * i + static_cast<std::size_t>(k)] =
            static_cast<std::uint8_t>(std::clamp(255 * c[k] + 0.5f + dither, 0.0f, 255.0f));
    }
  });
  return out;
}

void write_png(const std::filesystem::path& path, const Image& image) { write_png(path, tone_map(image)); }

}  // namespace dreampm
