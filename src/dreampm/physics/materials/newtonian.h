// A weakly compressible Newtonian liquid.
#pragma once
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Word gamma_words[] = {{"linear", -1}};  // p = K/gamma (J^-gamma - 1) with gamma = -1 is K (1 - J)
inline constexpr Param newtonian_params[] = {
    {"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"},
    {"viscosity", "Pa s", 1.0e-3, 0, 1000, true, "dynamic viscosity"},
    {"bulk_modulus",
     "Pa",
     derived,
     1,
     1e11,
     true,
     "stiffness against compression; derived from max_compression if absent",
     {},
     false,
     "max_compression"},
    {"max_compression", "1", 0.01, 1e-4, 0.2, true, "largest wanted relative change of volume; gives the bulk modulus"},
    {"gamma", "1", 7, 1, 15, false, "exponent of the equation of state; linear for p = K (1 - J)", gamma_words},
    {"tension", "", 0, 0, 1, false, "whether the liquid can pull", flag_words, true},
    {"relaxation", "1", 1, 0, 10, false, "strength of anchoring J to the measured density; 0 turns it off"},
};
inline constexpr Preset::Value water_values[] = {{"density", 998.2}, {"viscosity", 1.0016e-3}};
inline constexpr Preset::Value oil_values[] = {{"density", 917}, {"viscosity", 0.084}};
inline constexpr Preset::Value honey_values[] = {{"density", 1420}, {"viscosity", 10}};
inline constexpr Preset newtonian_presets[] = {
    {"water", "20 C, CRC Handbook of Chemistry and Physics", water_values},
    {"oil", "olive oil at 20 C, CRC Handbook of Chemistry and Physics", oil_values},
    {"honey", "about 20 C, Yanniotis et al. 2006, J. Food Eng. 72:372", honey_values},
};

}  // namespace dreampm
