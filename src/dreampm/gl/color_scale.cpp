#include "dreampm/gl/color_scale.h"

#include <algorithm>

namespace dreampm::gl {

// Fitted by least squares to a path through OKLab (B. Ottosson, "A perceptual color space for image
// processing", 2020), t from 0 to 1: L = 0.28 + 0.62 t, hue = 305 - 200 t degrees, chroma = 0.115 +
// 0.055 t^2 - 0.052 sin^2(pi t). It leaves the path by at most 0.012.
constexpr std::array<Vec3f, 7> coefficients{
    Vec3f{0.2028f, 0.0720f, 0.3309f},    Vec3f{0.8045f, 0.8850f, 1.2389f},     Vec3f{-11.7121f, 1.8781f, -1.9383f},
    Vec3f{51.5545f, -9.2420f, -4.2617f}, Vec3f{-99.6398f, 17.9213f, 21.5190f}, Vec3f{90.0005f, -15.3350f, -28.2858f},
    Vec3f{-30.2797f, 4.7116f, 11.6691f},
};
constinit const std::array<Vec3f, 7> color_scale_coefficients = coefficients;

Vec3f color_scale(float t) {
  const float u = t > 0 ? std::min(t, 1.0f) : 0.0f;
  Vec3f c = coefficients[6];
  for (int k = 5; k >= 0; --k) c = c * u + coefficients[static_cast<std::size_t>(k)];
  return min(max(c, Vec3f{0, 0, 0}), Vec3f{1, 1, 1});
}

}  // namespace dreampm::gl
