#include "dreampm/play/model/control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/error.h"
#include "dreampm/physics/projection/time_step.h"
#include "dreampm/play/model/matter.h"

namespace dreampm::play {
namespace {

std::vector<std::string> matter_titles() {
  std::vector<std::string> titles;
  for (const Matter& m : matters()) titles.emplace_back(m.title);
  return titles;
}

std::vector<std::string> compare_choices() {
  std::vector<std::string> choices = matter_titles();
  choices.insert(choices.begin(), "the same");
  return choices;
}

/// Of the projection: shorter steps would be as many as those of the explicit solver.
constexpr double least_cfl = 0.5;

/// A control in the making. Its fallback is what Settings begin with.
class Row {
 public:
  Row(SettingMember member, std::string_view panel, std::string_view id, std::string_view label)
      : control_{{}, member, false} {
    control_.info.id = id, control_.info.panel = panel, control_.info.label = label;
    control_.info.fallback = control_.value(Settings{});
    if (std::holds_alternative<bool Settings::*>(member)) control_.info.choices = {"off", "on"};
  }
  Row(double WorldSettings::* member, std::string_view panel, std::string_view id, std::string_view label)
      : Row(SettingMember(member), panel, id, label) {
    control_.of_world = true;
  }
  Row&& range(double min, double max, std::string_view unit) && {
    control_.info.min = min, control_.info.max = max, control_.info.unit = unit;
    return std::move(*this);
  }
  Row&& decades() && {
    control_.info.decades = true;
    return std::move(*this);
  }
  Row&& choices(std::vector<std::string> names) && {
    control_.info.max = static_cast<double>(names.size() - 1), control_.info.choices = std::move(names);
    return std::move(*this);
  }
  SettingControl help(std::string_view text) && {
    control_.info.help = text;
    return std::move(control_);
  }

 private:
  SettingControl control_;
};

}  // namespace

const std::vector<std::string>& look_choices() {
  static const std::vector<std::string> names{"automatic", "points", "spheres", "matter"};
  return names;
}
const std::vector<std::string>& color_choices() {
  static const std::vector<std::string> names{"material", "speed", "pressure", "J", "Jp", "age"};
  return names;
}

const ControlInfo& find_control(const std::vector<ControlInfo>& controls, const std::string& id) {
  const auto control = std::find_if(controls.begin(), controls.end(), [&](const auto& c) { return c.id == id; });
  if (control != controls.end()) return *control;
  std::string names;
  for (const ControlInfo& c : controls) names += " " + c.id;
  throw InputError(fmt::format("set: there is no control '{}'; there are{}", id, names));
}

void check_value(const ControlInfo& control, double value) {
  if (!(value >= control.min && value <= control.max))
    throw InputError(fmt::format("set: {} is {}: must be between {} and {} {}", control.id, value, control.min,
                                 control.max, control.unit));
  if (!control.choices.empty() && value != std::floor(value))
    throw InputError(fmt::format("set: {} is {}: must be a whole number", control.id, value));
}

double SettingControl::value(const Settings& settings) const {
  return std::visit([&](auto which) { return static_cast<double>(settings.*which); }, member);
}

void SettingControl::set(Settings& settings, double value) const {
  if (const auto* on = std::get_if<bool Settings::*>(&member))
    settings.** on = value != 0;
  else if (const auto* choice = std::get_if<std::size_t Settings::*>(&member))
    settings.** choice = static_cast<std::size_t>(value);
  else
    settings.*std::get<double Settings::*>(member) = value;
}

const std::vector<SettingControl>& setting_controls() {
  using S = Settings;
  static const std::vector<SettingControl> all{
      Row(&S::paused, "Time", "paused", "Pause").help("time stands still; Space"),
      Row(&S::speed, "Time", "speed", "Playback speed")
          .range(1.0 / 64, 1, "x")
          .decades()
          .help("simulated seconds a second; slower shows more, and changes nothing else"),
      Row(&S::cfl, "Time", "cfl", "Cells in a step")
          .range(least_cfl, largest_projection_cfl, "")
          .help(
              "that most matter crosses in a large step: 1 keeps more of a splash, 3 is faster; small ones show more"),
      Row(&S::time_step, "Report", "time_step", "Time Step")
          .range(0, 4, "x 1e-4 s")
          .help("asked for each of the 25 substeps of a drawn frame; what is taken is what the matter can take"),
      Row(&S::auto_restart, "Report", "auto_restart", "Auto Restart")
          .help("on: a change of the material begins anew; off: it forgets the deformation, and goes on where it is"),
      Row(&S::gravity_x, "World", "gravity.x", "Gravity x").range(-10, 10, "m/s^2").help("to the right"),
      Row(&S::gravity_y, "World", "gravity.y", "Gravity y").range(-10, 10, "m/s^2").help("up; the earth's is -9.81"),
      Row(&S::gravity_z, "World", "gravity.z", "Gravity z").range(-10, 10, "m/s^2").help("to the front"),
      Row(&S::matter, "Matter", "matter", "Matter")
          .choices(matter_titles())
          .help("what is poured and dropped; keys 1 to 0"),
      Row(&S::tool, "Brush", "tool", "Tool").choices(tool_names()).help("what a drag with the left button does"),
      Row(&S::radius, "Brush", "radius", "Brush radius")
          .range(0.02, 0.3, "m")
          .decades()
          .help("of the ring under the cursor"),
      Row(&S::strength, "Brush", "strength", "Brush strength")
          .range(0.1, 10, "")
          .decades()
          .help("how firmly the brush takes matter along"),
      Row(&S::drop, "Brush", "drop", "Drop a")
          .choices(drop_names())
          .help("what the tool drop lets fall: crate, brick and ball are rigid, the others of the chosen matter"),
      Row(&S::compare_with, "Compare", "compare_with", "Side B")
          .choices(compare_choices())
          .help("what takes the place of the main matter there"),
      Row(&S::look, "Picture", "look", "Look")
          .choices(look_choices())
          .help("automatic: the best that this machine draws in time"),
      Row(&S::color_by, "Picture", "color_by", "Color by")
          .choices(color_choices())
          .help("material, or a number with its scale"),
      Row(&S::random_colors, "Picture", "random_colors", "Use Random Colors")
          .help("each particle in a color of its own"),
      Row(&S::foam, "Picture", "foam", "Foam")
          .help("spray, foam and bubbles of liquids, dust of snow and sand, by the scene's key foam"),
      Row(&S::dark, "Picture", "dark", "Dark").help("a dark background"),
      Row(&S::scale_bar, "Picture", "scale_bar", "Scale bar").help("a length, at the depth of the middle of the box"),
      Row(&S::outline, "Picture", "outline", "Edges of the box").help(""),
  };
  return all;
}

}  // namespace dreampm::play
