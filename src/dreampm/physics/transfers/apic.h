// The affine particle-in-cell method (Jiang et al. 2015): momentum and angular momentum are kept,
// what a particle's 27 nodes cannot represent is damped. The default; nothing is stored for it.
#pragma once
#include <array>

#include "dreampm/physics/kept_velocity.h"
#include "dreampm/physics/member_param.h"

namespace dreampm {

struct Apic {
  static constexpr std::string_view name = "apic", help = "keeps angular momentum, damps what the grid cannot resolve";
  static constexpr std::array<MemberParam<Apic>, 0> params{};
  TransferRule<double> rule(const CellTimes& = {}) const { return {}; }
};

}  // namespace dreampm
