// Sand in the liquid of a projection: grains and the liquid in their pores are two phases, each
// with its own velocity, that a drag draws together (after Tampubolon et al. 2017, "Multi-species
// simulation of porous sand and water mixtures"). The pressure keeps the volume of both together;
// what grains carry among themselves is left to their explicit steps, so that a heap under water
// stands.
#pragma once
#include <vector>

#include "dreampm/solver/projection/mac_grid.h"
#include "dreampm/solver/projection/matter_transfers.h"

namespace dreampm {

/// Numbers of grains in a liquid.
struct GrainNumbers {
  /// The volume fraction of grains in a heap at rest. The rest are pores.
  static constexpr double packing = 0.6;
  /// The largest volume fraction in a face or a cell, where grains are pressed together more than
  /// they can be.
  static constexpr double most_packing = 0.85;
  /// m, of a grain, where the material gives no `grain_size`.
  static constexpr double diameter = 1e-3;
  /// 1/s: drag over the mass of the liquid that a grain of `diameter` displaces, for the speed at
  /// which quartz settles alone in water, 0.15 m/s: g (2.65 - 1)/0.15 less Stokes's part.
  static constexpr double inertial_drag = 90;
};

/// 1/s: drag of the liquid on lone grains, over the mass of the liquid that they displace; in a
/// heap it grows by 1/pores (Richardson and Zaki 1954, with an exponent of 3).
double grain_drag(double diameter, double viscosity);

template <class R>
class Grains {
 public:
  bool any() const { return any_; }
  /// Finds the shares of grains in cells and faces; after particles_to_grid.
  void to_grid(const World<R>& world, MacGrid<R>& grid);
  /// Mixes velocities; after mix_velocities and find_depths. On faces with grains the free velocity
  /// becomes that of the volume of both, after `kick` [s] of drag, and the lightness becomes the
  /// change of it by pressure.
  void mix(const World<R>& world, MacGrid<R>& grid, double kick);
  /// Separates liquid and grains; after apply_pressure. The velocities of faces become those of the
  /// liquid alone. Particles of grains get the change of their velocity and its slope by pressure
  /// and drag, and `pushes`. Gravity gives `gained` [m/s]; `lasts`: of cells, the lasting part of
  /// the pressure.
  void part(World<R>& world, MacGrid<R>& grid, const Vec3d& gained, const LargeVector<R>& lasts, Pushes<R>& pushes);

 private:
  using Faces = std::array<LargeVector<R>, 3>;

  bool any_ = false;
  Faces volume_;                       ///< of grains, over a cell
  Faces own_;                          ///< velocity of grains: before, then what it gained [m/s]
  Faces flux_;                         ///< that of both, as mix() left it [m/s]
  Faces liquid_, grains_;              ///< velocities after drag, before the pressure [m/s]
  Faces liquid_light_, grains_light_;  ///< what they lose to a slope of the pressure of 1
  Faces push_;                         ///< what lasts of that [m/s]
};

}  // namespace dreampm
