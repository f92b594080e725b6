// What can be set in the playground: the one list that panel, scripts, help and tests go by.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dreampm::play {

/// A setting. Its value is a number; one with choices is a whole number that counts them.
struct ControlInfo {
  std::string id;     ///< in scripts: "gravity.y", "material.water.viscosity"
  std::string panel;  ///< under which heading it stands
  std::string label, unit, help;
  double min = 0, max = 1;
  double fallback = 0;  ///< what it is reset to
  bool decades = false;
  std::vector<std::string> choices = {};  ///< empty: a slider; "off", "on": a switch
  /// Not empty: one of three that stand in a row, the red, green and blue of the color of that
  /// name.
  std::string color = {};
  /// Not empty: the switch that must be on, or off, for this to change anything.
  std::string needs = {};
  bool needs_off = false;
  bool advanced = false;  ///< shown where all are asked for

  bool is_switch() const { return choices.size() == 2 && choices[0] == "off" && choices[1] == "on"; }
  bool operator==(const ControlInfo&) const = default;
};

/// The control of that id. Throws InputError that names all where there is none.
const ControlInfo& find_control(const std::vector<ControlInfo>& controls, const std::string& id);
/// Throws InputError for a value that the control cannot have.
void check_value(const ControlInfo& control, double value);

/// Between which values of a control the matter can be played live.
struct LiveRange {
  double min, max;
  /// Whether it ends there because softer matter would be crushed; else time would nearly stand
  /// still.
  bool min_is_soft = false, max_is_soft = false;
};

/// What is set of the world itself: undo takes it back.
struct WorldSettings {
  double cfl = 2;                                          ///< of the projection: cells that matter crosses in a step
  double gravity_x = 0, gravity_y = -9.81, gravity_z = 0;  ///< m/s^2

  bool operator==(const WorldSettings&) const = default;
};

/// How a playground is set, apart from its matter.
struct Settings : WorldSettings {
  // Of time.
  bool paused = false;
  double speed = 1;      ///< simulated seconds a second
  double time_step = 2;  ///< of the report's scenes [1e-4 s], of which a drawn frame takes 25
  bool auto_restart = true;
  // Of the tools.
  std::size_t matter = 0;        ///< index into matters()
  std::size_t tool = 0;          ///< index into tool_names()
  double radius = 0.08;          ///< m, of the brush
  double strength = 1;           ///< of the brush
  std::size_t drop = 0;          ///< index into drop_names()
  std::size_t compare_with = 0;  ///< 0: the same; from 1 on an index into matters(), plus 1
  // Of the picture.
  std::size_t look = 0;      ///< index into look_choices()
  std::size_t color_by = 0;  ///< index into color_choices()
  bool random_colors = false;
  bool dark = false;
  bool outline = true;
  bool scale_bar = true;
  bool foam = false;

  bool operator==(const Settings&) const = default;
};

/// A member of Settings: a switch, one of some choices, or a number.
using SettingMember = std::variant<bool Settings::*, std::size_t Settings::*, double Settings::*>;

/// A setting that is a member of Settings. In scripts, panels and frames its value is a number.
struct SettingControl {
  ControlInfo info;
  SettingMember member;
  bool of_world = false;  ///< whether it changes what happens, and not only how it is seen or worked on

  double value(const Settings& settings) const;
  /// `value` is in the range of the control, and whole where it has choices.
  void set(Settings& settings, double value) const;
};
const std::vector<SettingControl>& setting_controls();

/// Of the tools that have a button, in its order (tools/tools.cpp).
const std::vector<std::string>& tool_names();
const std::vector<std::string>& drop_names();
const std::vector<std::string>& look_choices();
const std::vector<std::string>& color_choices();

/// Chooses the other solver.
inline constexpr char solver_key = 'S';
/// Substeps of the report's program in a drawn frame.
inline constexpr int report_substeps = 25;
/// Spacings: the radius of the thinnest jet. Thinner ones fall apart into single particles.
inline constexpr double least_jet = 3;

}  // namespace dreampm::play
