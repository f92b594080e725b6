// The material of the report that asked for this project: a slider from liquid to solid (docs/theory.md lists its
// errata).
#pragma once
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Param seed_params[] = {
    {"density", "kg/m^3", 1, 1e-3, 25000, true, "mass per volume at rest"},
    {"youngs_modulus", "Pa", 1000, 1, 1e9, true, "E of the report: mu = E V, lambda = E (1 - V)"},
    {"v", "1", 0.5, 0, 0.7, false, "the report's V: 0 is a fluid, 0.7 the stiffest; ignored if elastic"},
    {"elastic", "", 0, 0, 1, false, "purely elastic: no plasticity, Lame parameters of E and nu times h", flag_words,
     true},
    {"h", "1", 0.3, 0.01, 10, false, "hardness of the elastic object"},
    {"poissons_ratio", "1", 0.2, -0.95, 0.495, false, "nu of the elastic object"},
    {"lower", "1", -250, -10000, 0, false, "plasticity lower bound: singular values stay above 1 + lower 1e-4"},
    {"upper", "1", 45, 0, 10000, false, "plasticity upper bound: singular values stay below 1 + upper 1e-4"},
    {"hardening", "1", 10, 0, 50, false, "xi of the factor exp(xi (1 - Jp))"},
};

}  // namespace dreampm
