// The blend of FLIP and PIC (Brackbill and Ruppel 1986; Zhu and Bridson 2005): particles keep their
// own velocity and take the grid's change of it. Little damping, more noise; angular momentum is
// not kept.
#pragma once
#include "dreampm/physics/kept_velocity.h"

namespace dreampm {

struct Flip {
  double flip_blend = KeptVelocity::absent;   ///< 0: PIC, 1: FLIP
  double flip_memory = KeptVelocity::absent;  ///< s

  static constexpr std::string_view name = "flip", help = "particles keep their own velocity: lively, noisy";
  static constexpr MemberParam<Flip> params[] = {
      {"flip_blend", "", &Flip::flip_blend, nullptr, 0, 1, false, false,
       "share of the own velocity that a step keeps, however long it is; 0: PIC, 1: FLIP"},
      {"flip_memory", "s", &Flip::flip_memory, nullptr, 0, 1e6, true, false,
       "time in which a particle forgets its own velocity"}};
  /// The default keeps 0.99 of the longest stable steps.
  TransferRule<double> rule(const CellTimes& cell) const {
    return KeptVelocity{flip_blend, flip_memory}.rule(0, 0, 50 * cell.wave);
  }
};

}  // namespace dreampm
