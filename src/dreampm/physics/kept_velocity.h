// Keys of scenes for the own velocities of particles, and the defaults for how long these are kept.
#pragma once
#include "dreampm/physics/transfer_rule.h"

namespace dreampm {

/// Times [s] that a cell has by itself.
struct CellTimes {
  double wave = 0;  ///< in which the material's sound crosses it
  /// sqrt(dx/g), in which gravity moves matter at rest by half of it: of liquids under gravity,
  /// else 0.
  double fall = 0;
};

/// The numbers that a scene leaves out lie outside their ranges.
struct KeptVelocity {
  static constexpr double absent = -1;
  double blend = absent;   ///< of every step, however long
  double memory = absent;  ///< s

  /// `natural` [s]: the memory where neither is given.
  TransferRule<double> rule(double affine, double advance, double natural) const {
    if (blend >= 0) return {affine, blend, advance, 0};
    return {affine, 1, advance, memory > 0 ? memory : natural};
  }
};

}  // namespace dreampm
