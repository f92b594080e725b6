// Colors of sRGB and their light (IEC 61966-2-1).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dreampm/math/vec.h"

namespace dreampm {

/// The light of a value from 0 to 1, and back.
template <class R>
R linear_from_srgb(R c) {
  return c <= R(0.04045) ? c / R(12.92) : std::pow((c + R(0.055)) / R(1.055), R(2.4));
}
template <class R>
R srgb_from_linear(R x) {
  return x <= R(0.0031308) ? R(12.92) * x : R(1.055) * std::pow(x, 1 / R(2.4)) - R(0.055);
}

/// The byte of sRGB that is nearest to light; light beyond 0 to 1 is cut off.
template <class R>
std::uint8_t srgb_byte(R linear) {
  return static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(std::clamp(linear, R(0), R(1)))));
}

inline Vec3f linear_color(const Vec3d& srgb) {
  return static_cast<Vec3f>(Vec3d{linear_from_srgb(srgb.x), linear_from_srgb(srgb.y), linear_from_srgb(srgb.z)});
}

}  // namespace dreampm
