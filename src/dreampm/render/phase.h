// The phase function of Henyey and Greenstein (1941), "Diffuse radiation in the Galaxy".
#pragma once
#include "dreampm/render/color.h"

namespace dreampm::trace {

/// Of light that turns by an angle of that cosine [1/sr]. g: the mean cosine.
inline float phase(float cos_turn, float g) {
  const float k = 1 + g * g - 2 * g * cos_turn;
  return (1 - g * g) / (4 * pi * k * std::sqrt(k));
}

/// A direction after d with that density, for a, b uniform in [0, 1).
inline Vec3f sample_phase(const Vec3f& d, float g, float a, float b) {
  float c = 1 - 2 * a;
  if (std::fabs(g) > 1e-3f) {
    const float k = (1 - g * g) / (1 - g + 2 * g * a);
    c = (1 + g * g - k * k) / (2 * g);
  }
  const float s = std::sqrt(std::max(0.0f, 1 - c * c)), phi = 2 * pi * b;
  return Frame(d).world(s * std::cos(phi), s * std::sin(phi), c);
}

}  // namespace dreampm::trace
