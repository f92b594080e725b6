// Colors of sRGB and their light (IEC 61966-2-1).
#pragma once
#include <cmath>

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

inline Vec3f linear_color(const Vec3d& srgb) {
  return static_cast<Vec3f>(Vec3d{linear_from_srgb(srgb.x), linear_from_srgb(srgb.y), linear_from_srgb(srgb.z)});
}

}  // namespace dreampm
