// ASFLIP: affine FLIP with separation (Fei et al. 2021, "Revisiting integration in the material
// point method"): velocities as FLIP with APIC's affine part, and matter that is not pressed moves
// on with its own velocity instead of the grid's, so that pieces come apart.
#pragma once
#include "dreampm/physics/kept_velocity.h"

namespace dreampm {

struct Asflip {
  double flip_blend = KeptVelocity::absent;   ///< share of a particle's own velocity that a step keeps
  double separation = 1;                      ///< share of it that also moves matter that is not pressed
  double flip_memory = KeptVelocity::absent;  ///< s

  static constexpr std::string_view name = "asflip", help = "lively, and comes apart easily: grains, splashes";
  static constexpr MemberParam<Asflip> params[] = {
      {"flip_blend", "", &Asflip::flip_blend, nullptr, 0, 1, false, false,
       "share of the own velocity that a step keeps, however long it is; 0: PIC, 1: FLIP"},
      {"flip_memory", "s", &Asflip::flip_memory, nullptr, 0, 1e6, true, false,
       "time in which a particle forgets its own velocity"},
      {"separation", "", &Asflip::separation, nullptr, 0, 1, false, false,
       "share of it that moves matter not pressed"}};
  /// The default keeps 0.95 of the longest stable steps. Liquids that gravity moves remember
  /// longer: with less, a light body rises in them as in syrup (validate rigid-rise), with twice as
  /// much they stir themselves.
  TransferRule<double> rule(const CellTimes& cell) const {
    return KeptVelocity{flip_blend, flip_memory}.rule(1, separation, std::max(10 * cell.wave, cell.fall / 2));
  }
};

}  // namespace dreampm
