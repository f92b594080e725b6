#include "dreampm/play/model/facts.h"

#include <fmt/format.h>

#include <functional>
#include <map>

#include "dreampm/model/scene.h"
#include "dreampm/physics/param.h"
#include "dreampm/play/model/live_range.h"
#include "dreampm/play/model/number_text.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {

std::vector<std::string> material_facts(const Simulation& simulation) {
  std::vector<std::string> lines;
  const model::Scene& scene = simulation.scene().model();
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const MaterialState f = simulation.material(scene.materials[m].name);
    if (is_projection(scene) && info_of(scene.materials[m]).liquid) {
      const model::Material& liquid = scene.materials[m];
      lines.push_back(fmt::format("{}: {:.4g} kg/m^3, incompressible", liquid.name, liquid.values["density"]));
      if (f.kinematic_viscosity > 0) lines.back() += fmt::format(", viscosity {:.3g} m^2/s", f.kinematic_viscosity);
      continue;
    }
    const double nu = f.poissons_ratio, density = scene.materials[m].values["density"];
    std::string line = fmt::format("{}: ", scene.materials[m].name);
    // Of small strains, from the speed of sound: that of a wave that compresses, rho c^2 =
    // E (1 - nu) / ((1 + nu) (1 - 2 nu)).
    if (nu < 0.5)
      line += fmt::format(
          "E {}, ", with_unit(density * f.sound_speed * f.sound_speed * (1 + nu) * (1 - 2 * nu) / (1 - nu), "Pa"));
    line += fmt::format("{:.4g} kg/m^3, sound {:.3g} m/s, Poisson's ratio {:.2f}", density, f.sound_speed, nu);
    if (f.kinematic_viscosity > 0) line += fmt::format(", viscosity {:.3g} m^2/s", f.kinematic_viscosity);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string remedy(const Simulation& simulation, std::string_view limiter) {
  if (is_projection(simulation.scene().model()))
    return limiter == "speed"  ? "more cells in a step, slower matter, or a larger spacing"
           : limiter == "wave" ? "a larger spacing, or less gravity"
                               : "";
  static const std::map<std::string, std::string, std::less<>> remedies{
      {"wave", "softer matter, more max compression of a liquid, or a larger spacing"},
      {"speed", "slower matter, or a larger spacing"},
      {"viscosity", "a lower viscosity"},
  };
  const auto known = remedies.find(limiter);
  if (known == remedies.end()) return "";
  // Whose waves, or whose viscosity, are the fastest to cross a cell.
  const bool is_wave = limiter == "wave";
  if (!is_wave && limiter != "viscosity") return known->second;
  std::string name;
  double most = 0;
  for (const std::string& material : simulation.scene().materials()) {
    if (simulation.particle_count(material) == 0) continue;
    const MaterialState m = simulation.material(material);
    const double value = is_wave ? m.sound_speed : m.kinematic_viscosity;
    if (value > most) most = value, name = material;
  }
  return name.empty() ? known->second : fmt::format("{}: {}", name, known->second);
}

std::string softness_warning(const Simulation& simulation, const std::vector<ControlInfo>& controls,
                             const std::vector<double>& before, const std::vector<double>& now) {
  const std::string soft = too_soft(simulation, controls, now);
  if (soft.empty() || soft == too_soft(simulation, controls, before)) return "";
  return fmt::format("{} is so soft that what lies on it, or a fall, may crush it for good: Undo", soft);
}

}  // namespace dreampm::play
