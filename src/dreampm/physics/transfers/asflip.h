// ASFLIP: affine FLIP with separation (Fei et al. 2021, "Revisiting integration in the material
// point method"): velocities as FLIP with APIC's affine part, and matter that is not pressed moves
// on with its own velocity instead of the grid's, so that pieces come apart.
#pragma once
#include "dreampm/physics/transfer_rule.h"

namespace dreampm {

struct Asflip {
  double flip_blend = 0.95;  ///< share of a particle's own velocity that it keeps
  double separation = 1;     ///< share of it that also moves matter that is not pressed

  static constexpr std::string_view name = "asflip", help = "lively, and comes apart easily: grains, splashes";
  static constexpr MemberParam<Asflip> params[] = {
      {"flip_blend", "", &Asflip::flip_blend, nullptr, 0, 1, false, false, "share of the own velocity that is kept"},
      {"separation", "", &Asflip::separation, nullptr, 0, 1, false, false,
       "share of it that moves matter not pressed"}};
  TransferRule<double> rule() const { return {1, flip_blend, separation}; }
};

}  // namespace dreampm
