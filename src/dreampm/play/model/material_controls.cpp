#include "dreampm/play/model/material_controls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/math/look_color.h"
#include "dreampm/model/scene.h"
#include "dreampm/physics/param.h"
#include "dreampm/play/model/solver_choice.h"

namespace dreampm::play {
namespace {

/// Decades below and above its default that the slider of a parameter covers.
constexpr double slider_decades = 3;
/// How far a material goes in a tick to what was asked for: by this factor, or this part of the
/// slider.
constexpr double most_factor = 1.6, most_part = 0.06;

constexpr std::string_view prefix = "material.";

/// What the slider of a parameter covers, of a material where it has that value.
void set_range(const Param& p, double value, ControlInfo& c) {
  c.min = p.min, c.max = p.max;
  if (p.log && value > 0) {
    c.min = std::max(p.min, value * std::pow(10, -slider_decades));
    c.max = std::min(p.max, value * std::pow(10, slider_decades));
  }
  if (!std::isnan(p.slider.min)) c.min = p.slider.min;
  if (!std::isnan(p.slider.max)) c.max = p.slider.max;
  c.decades = p.log && c.min > 0;
}

ControlInfo control_of(const model::Material& m, const Param& p, double value) {
  const std::span<const Param> table = info_of(m).params;
  const bool shows_all = std::none_of(table.begin(), table.end(), [](const Param& q) { return q.slider.basic; });
  ControlInfo c;
  c.id = material_control_id(m.name, p.key);
  c.panel = m.name;
  c.label = std::string(p.slider.label.empty() ? p.key : p.slider.label);
  if (p.slider.label.empty()) std::replace(c.label.begin(), c.label.end(), '_', ' ');
  c.advanced = !shows_all && !p.slider.basic;
  c.unit = p.unit == "1" ? "" : std::string(p.unit);
  c.help = std::string(p.help);
  c.needs_off = !p.slider.needs_off.empty();
  if (const std::string_view other = c.needs_off ? p.slider.needs_off : p.slider.needs_on; !other.empty())
    c.needs = material_control_id(m.name, other);
  c.fallback = value;
  if (p.words_only) {
    for (const Word& w : p.words) c.choices.emplace_back(w.name);
    if (c.choices == std::vector<std::string>{"false", "true"}) c.choices = {"off", "on"};
    c.min = p.min, c.max = static_cast<double>(c.choices.size() - 1);
  } else {
    set_range(p, value, c);
  }
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

/// Null for controls of something else.
const LookControl* look_control(std::string_view key) {
  const auto known =
      std::find_if(std::begin(look_controls), std::end(look_controls), [&](const auto& l) { return l.key == key; });
  return known == std::end(look_controls) ? nullptr : known;
}

/// How a material looks before somebody changes its colors.
MatterLook first_look(const PlayScene& scene, const model::Look& look, const std::string& material) {
  MatterLook own = look_of(look);
  if (const auto given = scene.opacity.find(material); given != scene.opacity.end())
    own.opacity = static_cast<float>(given->second);
  // Balls of the report's size, and no grains.
  if (scene.report && std::exchange(own.grains, false)) own.ball = static_cast<float>(look.radius);
  return own;
}

/// What a control is reset to is how the scene has it.
double scene_value(const PlayScene& scene, const model::Material& m, std::string_view key) {
  for (const model::Material& given : scene.scene.model().materials)
    if (given.name == m.name) return given.values[key];
  return m.values[key];
}

void add_parameters(const PlayScene& scene, const model::Scene& now, const model::Material& m,
                    std::vector<ControlInfo>& all) {
  for (const Param& p : info_of(m).params) {
    // What the solver derives follows from the rest.
    if (!m.values.has(p.key) || !has_effect(now, m, p.key)) continue;
    const double fallback = scene_value(scene, m, p.key);
    ControlInfo c = control_of(m, p, fallback);
    if (m.type == "seed" && p.key == "h" && scene.report) c.max = scene.max_hard;
    if (c.choices.empty()) {
      c.min = allowed_end(now, m, std::string(p.key), c.min), c.max = allowed_end(now, m, std::string(p.key), c.max);
      c.fallback = std::clamp(fallback, c.min, c.max);
    }
    if (c.min < c.max) all.push_back(std::move(c));
  }
}

void add_look(const model::Material& m, MatterLook look, std::vector<ControlInfo>& all) {
  if (look.clear) return;
  for (const LookControl& l : look_controls) {
    ControlInfo c;
    c.id = material_control_id(m.name, l.key);
    c.panel = m.name, c.label = l.label, c.help = l.help;
    c.fallback = static_cast<double>(*l.member(look));
    if (l.key.starts_with("color.")) c.color = material_control_id(m.name, "color");
    all.push_back(std::move(c));
  }
}

}  // namespace

MatterLook look_of(const model::Look& look) {
  MatterLook own;
  own.clear = is_clear(look);
  own.grains = look.type == model::LookType::spheres;
  own.color = static_cast<Vec3f>(look.color);
  if (look.type == model::LookType::dielectric && !own.clear) own.color = shown_color(look);
  own.absorption = static_cast<Vec3f>(look.absorption);
  own.refractive_index = static_cast<float>(look.ior);
  return own;
}

std::string material_control_id(std::string_view material, std::string_view key) {
  return fmt::format("{}{}.{}", prefix, material, key);
}

std::optional<MaterialKey> material_key(std::string_view id) {
  if (!id.starts_with(prefix)) return std::nullopt;
  const std::size_t dot = id.find('.', prefix.size());
  if (dot == id.npos) return std::nullopt;
  return MaterialKey{std::string(id.substr(prefix.size(), dot - prefix.size())), std::string(id.substr(dot + 1))};
}

std::vector<ControlInfo> material_controls(const PlayScene& scene, const Simulation& simulation, Looks& looks) {
  std::vector<ControlInfo> all;
  const model::Scene& now = simulation.scene().model();
  for (const model::Material& m : now.materials) {
    const MatterLook own = first_look(scene, now.render.looks.at(m.name), m.name);
    // Colors stay as they are set.
    looks.try_emplace(m.name, own);
    add_parameters(scene, now, m, all);
    add_look(m, own, all);
  }
  return all;
}

float* look_member(Looks& looks, std::string_view id) {
  const auto name = material_key(id);
  const LookControl* const control = name ? look_control(name->key) : nullptr;
  const auto look = control ? looks.find(name->material) : looks.end();
  return look == looks.end() ? nullptr : control->member(look->second);
}

double material_value(const ControlInfo& control, const Simulation& simulation, const Looks& looks) {
  const auto name = material_key(control.id);
  if (!name) return control.fallback;
  if (const LookControl* const own = look_control(name->key))
    if (const auto look = looks.find(name->material); look != looks.end()) {
      MatterLook copy = look->second;
      return static_cast<double>(*own->member(copy));
    }
  for (const model::Material& m : simulation.scene().model().materials)
    if (m.name == name->material) return m.values[name->key];
  return control.fallback;
}

void set_parameter(Simulation& simulation, std::string_view id, double value) {
  if (const auto name = material_key(id)) simulation.set_parameter(name->material, name->key, value);
}

double next_value(const ControlInfo& control, double now, double target) {
  if (!control.choices.empty()) return target;
  if (control.decades && now > 0) return std::clamp(target, now / most_factor, now * most_factor);
  const double most = most_part * (control.max - control.min);
  return std::clamp(target, now - most, now + most);
}

std::vector<std::string> approach_targets(Simulation& simulation, const std::vector<ControlInfo>& controls,
                                          const Looks& looks, Targets& targets) {
  std::vector<std::string> reached;
  for (auto target = targets.begin(); target != targets.end();) {
    const auto& [id, wanted] = *target;
    const auto control =
        std::find_if(controls.begin(), controls.end(), [&, &name = id](const auto& c) { return c.id == name; });
    if (control == controls.end()) {
      target = targets.erase(target);
      continue;
    }
    const double next = next_value(*control, material_value(*control, simulation, looks), wanted);
    set_parameter(simulation, id, next);
    if (next != wanted) {
      ++target;
      continue;
    }
    reached.push_back(material_key(id)->material);
    target = targets.erase(target);
  }
  return reached;
}

}  // namespace dreampm::play
