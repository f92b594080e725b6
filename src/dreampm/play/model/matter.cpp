#include "dreampm/play/model/matter.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace dreampm::play {
namespace {

// Stiff enough to look right in a box of a meter, and soft enough for steps of a few tenths of a
// millisecond there.
constexpr Matter kinds[] = {
    {"water", "Water", "{type: newtonian, preset: water, max_compression: 0.02}",
     "{type: dielectric, ior: 1.333, absorption: [6, 1.7, 0.5]}", '1', "honey"},
    {"honey", "Honey", "{type: newtonian, preset: honey, max_compression: 0.02}",
     "{type: dielectric, ior: 1.49, absorption: [2, 14, 70]}", '2', "water"},
    {"mud", "Mud", "{type: viscoplastic, preset: mud, max_compression: 0.02}",
     "{type: opaque, color: [0.36, 0.25, 0.16], roughness: 0.6}", '3', "water"},
    {"jelly", "Jelly", "{type: elastic, preset: jelly}", "{type: opaque, color: [0.80, 0.16, 0.28], roughness: 0.3}",
     '4', "stone"},
    {"rubber", "Rubber", "{type: neo_hookean, density: 950, youngs_modulus: 1.0e5, poissons_ratio: 0.45}",
     "{type: opaque, color: [0.15, 0.42, 0.75], roughness: 0.5}", '5', "jelly"},
    {"snow", "Snow", "{type: snow, preset: packed}", "{type: spheres, color: [0.93, 0.95, 0.98]}", '6', "water"},
    {"sand", "Sand", "{type: sand, preset: dry, youngs_modulus: 1.0e6}", "{type: spheres, color: [0.82, 0.66, 0.42]}",
     '7', "honey"},
    {"stone", "Stone", "{type: elastic, density: 2500, youngs_modulus: 1.0e6, poissons_ratio: 0.2}",
     "{type: opaque, color: [0.48, 0.48, 0.50], roughness: 1}", '8', "jelly"},
    {"toothpaste", "Toothpaste", "{type: viscoplastic, preset: toothpaste, max_compression: 0.02}",
     "{type: opaque, color: [0.75, 0.93, 0.90], roughness: 0.4}", '9', "honey"},
    {"diy", "DIY", "{type: seed, density: 1000, youngs_modulus: 1.0e5}", "{type: opaque, color: [0.90, 0.88, 0.82]}",
     '0', "jelly"},
};

}  // namespace

std::span<const Matter> matters() { return kinds; }

std::optional<std::size_t> kind_of(std::string_view name, std::string_view type, double viscosity) {
  const auto named = [](std::string_view n) {
    return static_cast<std::size_t>(std::ranges::find(kinds, n, &Matter::name) - std::begin(kinds));
  };
  if (const std::size_t kind = named(name); kind < std::size(kinds)) return kind;
  constexpr double thick = 0.5;  // Pa s
  if (type == "newtonian") return named(viscosity > thick ? "honey" : "water");
  if (type == "viscoplastic") return named("toothpaste");
  // The first whose type it is.
  const std::string start = "{type: " + std::string(type) + ",";
  for (std::size_t kind = 0; kind < std::size(kinds); ++kind)
    if (kinds[kind].scene.starts_with(start)) return kind;
  return std::nullopt;
}

std::size_t compared_with(std::size_t kind) {
  return static_cast<std::size_t>(std::ranges::find(kinds, kinds[kind].beside, &Matter::name) - std::begin(kinds));
}

Action compare_with(std::size_t choice) {
  Action action{"compare", {"on"}};
  if (choice > 0) action.words.emplace_back(matters()[choice - 1].name);
  return action;
}

}  // namespace dreampm::play
