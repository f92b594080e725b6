#include "dreampm/play/matter.h"

namespace dreampm::play {
namespace {

// Stiff enough to look right in a box of a meter, and soft enough for steps of a few tenths of a
// millisecond there.
constexpr Matter all[] = {
    {"water", "Water", "{type: newtonian, preset: water, max_compression: 0.02}",
     "{type: dielectric, ior: 1.333, absorption: [6, 1.7, 0.5]}", '1'},
    {"honey", "Honey", "{type: newtonian, preset: honey, max_compression: 0.02}",
     "{type: dielectric, ior: 1.49, absorption: [2, 14, 70]}", '2'},
    {"mud", "Mud", "{type: viscoplastic, preset: mud, max_compression: 0.02}",
     "{type: opaque, color: [0.36, 0.25, 0.16], roughness: 0.6}", '3'},
    {"jelly", "Jelly", "{type: elastic, preset: jelly}", "{type: opaque, color: [0.80, 0.16, 0.28], roughness: 0.3}",
     '4'},
    {"rubber", "Rubber", "{type: neo_hookean, density: 950, youngs_modulus: 1.0e5, poissons_ratio: 0.45}",
     "{type: opaque, color: [0.15, 0.42, 0.75], roughness: 0.5}", '5'},
    {"snow", "Snow", "{type: snow, preset: packed}", "{type: spheres, color: [0.93, 0.95, 0.98]}", '6'},
    {"sand", "Sand", "{type: sand, preset: dry, youngs_modulus: 1.0e6}", "{type: spheres, color: [0.82, 0.66, 0.42]}",
     '7'},
    {"stone", "Stone", "{type: elastic, density: 2500, youngs_modulus: 1.0e6, poissons_ratio: 0.2}",
     "{type: opaque, color: [0.48, 0.48, 0.50], roughness: 1}", '8'},
    {"toothpaste", "Toothpaste", "{type: viscoplastic, preset: toothpaste, max_compression: 0.02}",
     "{type: opaque, color: [0.75, 0.93, 0.90], roughness: 0.4}", '9'},
    {"diy", "DIY", "{type: seed, density: 1000, youngs_modulus: 1.0e5}", "{type: opaque, color: [0.90, 0.88, 0.82]}",
     '0'},
};

}  // namespace

std::span<const Matter> matters() { return all; }

}  // namespace dreampm::play
