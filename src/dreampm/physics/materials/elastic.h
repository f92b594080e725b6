// A fixed corotated elastic solid (Stomakhin et al. 2012, "Energetically consistent invertible elasticity").
#pragma once
#include "dreampm/physics/param.h"

namespace dreampm {

inline constexpr Param elastic_params[] = {
    {"density", "kg/m^3", 1000, 1, 25000, true, "mass per volume at rest"},
    {"youngs_modulus", "Pa", 2.0e4, 1, 1e11, true, "stiffness E"},
    {"poissons_ratio", "1", 0.3, -0.95, 0.495, false, "nu: how much it narrows when pulled"},
};
inline constexpr Preset::Value jelly_values[] = {
    {"density", 1010}, {"youngs_modulus", 1.0e4}, {"poissons_ratio", 0.45}};
inline constexpr Preset::Value rubber_values[] = {
    {"density", 1100}, {"youngs_modulus", 1.0e6}, {"poissons_ratio", 0.48}};
inline constexpr Preset elastic_presets[] = {
    {"jelly", "gelatine gel of 5 to 10 %, Markidou et al. 2005, Opt. Eng. 44:084001", jelly_values},
    {"rubber", "soft natural rubber, Treloar, The Physics of Rubber Elasticity", rubber_values},
};

}  // namespace dreampm
