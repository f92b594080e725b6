// Liquids at rest under their own weight, for tests.
#pragma once
#include "dreampm/validate/measure/hydrostatic.h"
#include "worlds.h"

namespace dreampm::test {
using validate::Hydrostatic;

/// A pressed block from the origin, of rest size `size`.
inline std::vector<Newborn> fill(const Hydrostatic& rest, const Vec3d& size, double spacing) {
  auto all = lattice({{}, size}, spacing, still());
  rest.move(all);
  return all;
}

}  // namespace dreampm::test
