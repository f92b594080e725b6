// Liquids at rest under their own weight, for tests.
#pragma once
#include "validate/measure/hydrostatic.h"
#include "worlds.h"

namespace dreampm::test {

/// The exact column, with blocks of lattice.
class Hydrostatic : public validate::Hydrostatic {
 public:
  using validate::Hydrostatic::Hydrostatic;
  /// A pressed block from the origin, of rest size `size`.
  std::vector<ParticleSeed> fill(const Vec3d& size, double spacing) const {
    auto all = lattice({{}, size}, spacing, still());
    move(all);
    return all;
  }
  /// Gives set 0 of a world just begun its pressure; `seeds` are its particles.
  template <class R>
  void press(World<R>& w, const std::vector<ParticleSeed>&) const {
    validate::Hydrostatic::press(w);
  }
};

}  // namespace dreampm::test
