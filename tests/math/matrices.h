// Random matrices for the tests of math/.
#pragma once
#include <cmath>
#include <random>

#include "dreampm/math/mat3.h"

namespace dreampm::test {

using Rng = std::mt19937_64;

inline double between(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

inline Mat3d random_rotation(Rng& rng) {
  std::normal_distribution<double> g;
  const Vec3d a = normalized(Vec3d{g(rng), g(rng), g(rng)});
  Vec3d b{g(rng), g(rng), g(rng)};
  for (int twice = 0; twice < 2; ++twice) b = normalized(b - a * dot(a, b));
  const Vec3d c = cross(a, b);
  return {{a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z}};
}

}  // namespace dreampm::test
