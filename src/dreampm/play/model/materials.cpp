// The controls of a playground: its settings, and the parameters of its materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/error.h"
#include "dreampm/model/scene.h"
#include "dreampm/physics/param.h"
#include "dreampm/play/model/firmness.h"
#include "dreampm/play/model/live_range.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/number_text.h"
#include "dreampm/play/model/play_model.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/report/report_config.h"
#include "dreampm/play/report/report_looks.h"

namespace dreampm::play {
namespace {

/// Decades below and above its default that the slider of a parameter covers.
constexpr double slider_decades = 3;
/// How far a material goes in a tick to what was asked for: by this factor, or this part of the
/// slider.
constexpr double most_factor = 1.6, most_part = 0.06;

constexpr std::string_view prefix = "material.";

/// Parameters that a beginner changes: the others are shown where all are asked for.
constexpr std::string_view plain[] = {
    "density",        "viscosity", "youngs_modulus", "poissons_ratio",       "yield_stress",     "consistency",
    "friction_angle", "cohesion",  "hardening",      "critical_compression", "critical_stretch", "max_compression"};
/// Names that are more than their keys without underscores.
constexpr std::pair<std::string_view, std::string_view> names[] = {
    {"youngs_modulus", "Young's modulus"},
    {"poissons_ratio", "Poisson's ratio"},
    {"tension", "can pull"},
    {"match", "match of the friction angle"},
    {"gamma", "gamma of the pressure"},
    {"inertial_number", "inertial number of the rise"},
};

/// What a slider covers, and how it is called, where that is not the default of all. `needs`: the
/// switch beside it without which it changes nothing; with a ! in front: which must be off.
struct Range {
  std::string_view material, key;
  double min, max;
  std::string_view label = {}, needs = {};
};
/// Those of seed are the report's, with its names, but for the end of `h`, which a stage says.
constexpr Range ranges[] = {
    {"newtonian", "viscosity", 1e-4, 1000},
    {"seed", "v", 0, 0.7, "V", "!elastic"},
    {"seed", "lower", -400, -100, "plasticity lower bound", "!elastic"},
    {"seed", "upper", 0, 100, "plasticity upper bound", "!elastic"},
    {"seed", "h", 0.25, 4, "Hard", "elastic"},
    {"seed", "elastic", 0, 1, "Elastic Object"},
    {"viscoplastic", "yield_stress", 0.1, 5000},
    {"viscoplastic", "consistency", 0.1, 1000},
    {"sand", "cohesion", 0, 20000},
};

ControlInfo control_of(const model::Material& m, const Param& p, double value, const PlayScene& stage) {
  ControlInfo c;
  c.id = fmt::format("{}{}.{}", prefix, m.name, p.key);
  c.panel = m.name;
  c.label = std::string(p.key);
  std::replace(c.label.begin(), c.label.end(), '_', ' ');
  for (const auto& [key, name] : names)
    if (key == p.key) c.label = name;
  // The report's are all of its own page.
  c.advanced = m.type != "seed" && std::find(std::begin(plain), std::end(plain), p.key) == std::end(plain);
  c.unit = p.unit == "1" ? "" : std::string(p.unit);
  c.help = std::string(p.help);
  c.min = p.min, c.max = p.max, c.fallback = value;
  for (const Range& r : ranges) {
    if (r.material != m.type || r.key != p.key) continue;
    if (!r.label.empty()) c.label = r.label;
    const bool is_off = r.needs.starts_with('!');
    if (!r.needs.empty()) c.needs = fmt::format("{}{}.{}", prefix, m.name, r.needs.substr(is_off ? 1 : 0));
    c.needs_off = is_off;
  }
  if (p.words_only) {
    for (const Word& w : p.words) c.choices.emplace_back(w.name);
    if (c.choices == std::vector<std::string>{"false", "true"}) c.choices = {"off", "on"};
    c.max = static_cast<double>(c.choices.size() - 1);
    return c;
  }
  c.decades = p.log;
  if (p.log && value > 0) {
    c.min = std::max(p.min, value * std::pow(10, -slider_decades));
    c.max = std::min(p.max, value * std::pow(10, slider_decades));
  }
  for (const Range& r : ranges)
    if (r.material == m.type && r.key == p.key) c.min = r.min, c.max = r.max;
  if (m.type == "seed" && p.key == "h" && stage.report) c.max = stage.max_hard;
  if (c.decades && !(c.min > 0)) c.decades = false;
  return c;
}

/// What a material is drawn with, behind its parameters.
struct LookControl {
  std::string_view key, label, help;
  float* (*member)(MatterLook&);
};
constexpr LookControl look_controls[] = {
    {"color.red", "color", "of the picture", [](MatterLook& l) { return &l.color.x; }},
    {"color.green", "color", "of the picture", [](MatterLook& l) { return &l.color.y; }},
    {"color.blue", "color", "of the picture", [](MatterLook& l) { return &l.color.z; }},
    {"opacity", "opacity", "1: nothing shines through", [](MatterLook& l) { return &l.opacity; }},
};

struct Named {
  std::string material, key;
};
/// Of the id of a material's control.
Named named_by(const std::string& id) {
  const std::size_t dot = id.find('.', prefix.size());
  return {id.substr(prefix.size(), dot - prefix.size()), id.substr(dot + 1)};
}

}  // namespace

MatterLook look_of(const model::Look& look) {
  MatterLook own;
  own.clear = look.type == model::LookType::dielectric;
  own.grains = look.type == model::LookType::spheres;
  own.color = static_cast<Vec3f>(look.color);
  own.absorption = static_cast<Vec3f>(look.absorption);
  own.refractive_index = static_cast<float>(look.ior);
  return own;
}

std::vector<std::string> mistyped_parameters() {
  std::vector<std::string> wrong;
  const auto has = [](const MaterialInfo* m, std::string_view key) { return m && m->find(key); };
  const auto any_has = [&](std::string_view key) {
    const auto all = material_infos();
    return std::any_of(all.begin(), all.end(), [&](const MaterialInfo& m) { return has(&m, key); });
  };
  for (const std::string_view key : plain)
    if (!any_has(key)) wrong.emplace_back(key);
  for (const auto& [key, name] : names)
    if (!any_has(key)) wrong.emplace_back(key);
  for (const Range& r : ranges) {
    const MaterialInfo* m = find_material(r.material);
    if (!has(m, r.key)) wrong.push_back(fmt::format("{}.{}", r.material, r.key));
    const std::string_view needs = r.needs.substr(r.needs.starts_with('!') ? 1 : 0);
    if (!needs.empty() && !has(m, needs)) wrong.push_back(fmt::format("{}.{}", r.material, needs));
  }
  return wrong;
}

void PlayModel::list_controls() {
  auto all = std::make_shared<std::vector<ControlInfo>>();
  for (const SettingControl& c : setting_controls()) {
    if (c.info.panel == "Report" && !play_scene().report) continue;
    if (c.info.id == "cfl" && !is_projection(play_scene().scene.model())) continue;
    all->push_back(c.info);
    if (c.info.id == "cfl") all->back().fallback = play_scene().scene.model().time.cfl;
    if (c.info.id == "time_step") all->back().max = play_scene().max_time_step;
    // Back to the gravity of the scene.
    const Vec3d& own = play_scene().scene.model().gravity;
    if (c.info.id == "gravity.x") all->back().fallback = own.x;
    if (c.info.id == "gravity.y") all->back().fallback = own.y;
    if (c.info.id == "gravity.z") all->back().fallback = own.z;
  }
  const model::Scene& scene = simulation->scene().model();
  // Colors stay as they are set.
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const model::Material& m = scene.materials[i];
    MatterLook own = look_of(scene.render.looks.at(m.name));
    if (const auto given = play_scene().opacity.find(m.name); given != play_scene().opacity.end())
      own.opacity = static_cast<float>(given->second);
    // Balls of the report's size, and no grains.
    if (play_scene().report && std::exchange(own.grains, false))
      own.ball = static_cast<float>(scene.render.looks.at(m.name).radius);
    looks.try_emplace(m.name, own);
    for (const Param& p : info_of(m).params)
      // What the solver derives follows from the rest.
      if (m.values.has(p.key) && has_effect(scene, m, p.key)) {
        // What a control is reset to is how the scene has it.
        double fallback = m.values[p.key];
        for (const model::Material& given : play_scene().scene.model().materials)
          if (given.name == m.name) fallback = given.values[p.key];
        ControlInfo c = control_of(m, p, fallback, play_scene());
        if (c.choices.empty())
          c.min = allowed_end(scene, m, std::string(p.key), c.min),
          c.max = allowed_end(scene, m, std::string(p.key), c.max), c.fallback = std::clamp(fallback, c.min, c.max);
        if (c.min < c.max) all->push_back(std::move(c));
      }
    if (own.clear) continue;
    for (const LookControl& l : look_controls) {
      ControlInfo c;
      c.id = fmt::format("{}{}.{}", prefix, m.name, l.key);
      c.panel = m.name, c.label = l.label, c.help = l.help;
      c.fallback = static_cast<double>(*l.member(own));
      if (l.key.starts_with("color.")) c.color = fmt::format("{}{}.color", prefix, m.name);
      all->push_back(std::move(c));
    }
  }
  controls = std::move(all);
  refusals = matter_refusals(scene);
}

float* PlayModel::look_member(const std::string& id) {
  for (const std::string& name : simulation->scene().materials())
    for (const LookControl& l : look_controls)
      if (id == fmt::format("{}{}.{}", prefix, name, l.key)) return l.member(looks.at(name));
  return nullptr;
}

double PlayModel::value_of(const ControlInfo& control) {
  for (const SettingControl& c : setting_controls())
    if (c.info.id == control.id) return c.value(settings);
  if (const float* member = look_member(control.id)) return static_cast<double>(*member);
  const Named n = named_by(control.id);
  for (const model::Material& m : simulation->scene().model().materials)
    if (m.name == n.material) return m.values[n.key];
  return control.fallback;
}

void PlayModel::set(const std::string& id, double value) {
  const auto control = std::find_if(controls->begin(), controls->end(), [&](const auto& c) { return c.id == id; });
  if (control == controls->end()) {
    std::string names;
    for (const ControlInfo& c : *controls) names += " " + c.id;
    throw InputError(fmt::format("set: there is no control '{}'; there are{}", id, names));
  }
  if (!(value >= control->min && value <= control->max))
    throw InputError(fmt::format("set: {} is {}: must be between {} and {} {}", id, value, control->min, control->max,
                                 control->unit));
  if (!control->choices.empty() && value != std::floor(value))
    throw InputError(fmt::format("set: {} is {}: must be a whole number", id, value));
  for (const SettingControl& c : setting_controls()) {
    if (c.info.id != id) continue;
    // A tilt sets all of gravity: one edit.
    if (c.of_world) before_edit("set " + id.substr(0, id.find('.')));
    const std::vector<double> before = asked_values();
    c.set(settings, value);
    if (c.of_world) see_softness(before);
    return;
  }
  if (float* member = look_member(id)) {
    *member = static_cast<float>(value);
    return;
  }
  if (value == value_of(*control) && !targets.contains(id)) return;
  before_edit("set " + id);
  const std::vector<double> before = asked_values();
  targets[id] = value;
  if (is_of_firmness(named_by(id).key)) see_softness(before);
  if (play_scene().report && settings.auto_restart) clock.restart_is_due = true;
}

std::vector<double> PlayModel::asked_values() {
  std::vector<double> values;
  for (const ControlInfo& c : *controls) {
    const auto target = targets.find(c.id);
    values.push_back(target == targets.end() ? value_of(c) : target->second);
  }
  return values;
}

void PlayModel::see_softness(const std::vector<double>& before) {
  const std::string soft = too_soft(*simulation, *controls, asked_values());
  if (soft.empty() || soft == too_soft(*simulation, *controls, before)) return;
  say(fmt::format("{} is so soft that what lies on it, or a fall, may crush it for good: Undo", soft));
}

void PlayModel::take_look(const ReportLook& look) {
  const std::string name = report_material_name(diy_material);
  const auto id_of = [&](std::string_view key) { return fmt::format("{}{}.{}", prefix, name, key); };
  const auto has = [&](const ControlInfo& c) { return c.id == id_of("v"); };
  if (!play_scene().report || std::none_of(controls->begin(), controls->end(), has))
    throw InputError("look: only the report's scenes have its material; open report 1");
  // Whatever it sets.
  before_own_edit("look");
  for (const auto& [key, value] : look.values()) targets[id_of(key)] = value;
  if (settings.auto_restart) clock.restart_is_due = true;
}

void PlayModel::set_material(const std::string& id, double value) {
  const Named n = named_by(id);
  simulation->set_parameter(n.material, n.key, value);
}

void PlayModel::approach_targets() {
  for (auto target = targets.begin(); target != targets.end();) {
    const auto& [id, wanted] = *target;
    const auto control =
        std::find_if(controls->begin(), controls->end(), [&, &name = id](const auto& c) { return c.id == name; });
    if (control == controls->end()) {
      target = targets.erase(target);
      continue;
    }
    const double now = value_of(*control);
    double next = wanted;
    if (control->choices.empty()) {
      if (control->decades && now > 0) {
        next = std::clamp(wanted, now / most_factor, now * most_factor);
      } else {
        const double most = most_part * (control->max - control->min);
        next = std::clamp(wanted, now - most, now + most);
      }
    }
    set_material(id, next);
    if (next != wanted) {
      ++target;
      continue;
    }
    // Of the report: the deformation is forgotten, places and velocities are kept.
    if (play_scene().report && !settings.auto_restart) simulation->reset_state(named_by(id).material);
    target = targets.erase(target);
  }
}

std::string PlayModel::ensure_matter(std::size_t kind) {
  if (const auto& own = compared.stand_in;
      own && matters()[kind].name == compared.stand_in_for && !other_liquid(simulation->scene().model(), *own))
    kind = *own;
  const Matter& matter = matters()[kind];
  const std::vector<std::string> names = simulation->scene().materials();
  if (std::find(names.begin(), names.end(), matter.name) != names.end()) return std::string(matter.name);
  if (!refusals[kind].empty())
    throw InputError(fmt::format("{}: {}; the other solver can (key {})", matter.title, refusals[kind], solver_key));
  const model::Scene& kinds = scene_of_kinds();
  simulation->add_material(kinds.materials.at(kind), kinds.render.looks.at(std::string(matter.name)));
  list_controls();
  return std::string(matter.name);
}

std::string PlayModel::remedy() const {
  if (is_projection(simulation->scene().model()))
    return meters.limiter == "speed"  ? "more cells in a step, slower matter, or a larger spacing"
           : meters.limiter == "wave" ? "a larger spacing, or less gravity"
                                      : "";
  static const std::map<std::string, std::string, std::less<>> remedies{
      {"wave", "softer matter, more max compression of a liquid, or a larger spacing"},
      {"speed", "slower matter, or a larger spacing"},
      {"viscosity", "a lower viscosity"},
  };
  const auto known = remedies.find(meters.limiter);
  if (known == remedies.end()) return "";
  // Whose waves, or whose viscosity, are the fastest to cross a cell.
  const bool is_wave = meters.limiter == "wave";
  if (!is_wave && meters.limiter != "viscosity") return known->second;
  std::string name;
  double most = 0;
  for (const std::string& material : simulation->scene().materials()) {
    if (simulation->particle_count(material) == 0) continue;
    const MaterialState m = simulation->material(material);
    const double value = is_wave ? m.sound_speed : m.kinematic_viscosity;
    if (value > most) most = value, name = material;
  }
  return name.empty() ? known->second : fmt::format("{}: {}", name, known->second);
}

std::vector<std::string> PlayModel::facts() const {
  std::vector<std::string> lines;
  const model::Scene& scene = simulation->scene().model();
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const MaterialState f = simulation->material(scene.materials[m].name);
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

}  // namespace dreampm::play
