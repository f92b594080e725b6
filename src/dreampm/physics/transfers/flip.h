// The blend of FLIP and PIC (Brackbill and Ruppel 1986; Zhu and Bridson 2005): particles keep their
// own velocity and take the grid's change of it. Little damping, more noise; angular momentum is
// not kept.
#pragma once
#include "dreampm/physics/transfer_rule.h"

namespace dreampm {

struct Flip {
  double flip_blend = 0.99;  ///< 0: PIC, 1: FLIP

  static constexpr std::string_view name = "flip", help = "particles keep their own velocity: lively, noisy";
  static constexpr MemberParam<Flip> params[] = {
      {"flip_blend", "", &Flip::flip_blend, nullptr, 0, 1, false, false, "0: all from the grid (PIC), 1: FLIP"}};
  TransferRule<double> rule() const { return {0, flip_blend, 0}; }
};

}  // namespace dreampm
