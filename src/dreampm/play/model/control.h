// What can be set in the playground: the one list that panel, scripts, help and tests go by.
#pragma once
#include <string>
#include <string_view>
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

/// What is said here of the sliders of parameters that no material has: a name was mistyped.
std::vector<std::string> mistyped_parameters();

/// Between which values of a control the matter can be played live.
struct LiveRange {
  double min, max;
  /// Whether it ends there because softer matter would be crushed; else time would nearly stand
  /// still.
  bool min_is_soft = false, max_is_soft = false;
};

/// How a playground is set, apart from its matter.
struct Settings {
  // Of time.
  double paused = 0;
  double speed = 1;      ///< simulated seconds a second
  double time_step = 2;  ///< of the report's scenes [1e-4 s], of which a drawn frame takes 25
  double auto_restart = 1;
  double cfl = 2;  ///< of the projection: cells that matter crosses in a step
  // Of the world.
  double gravity_x = 0, gravity_y = -9.81, gravity_z = 0;  ///< m/s^2
  // Of the hand.
  double matter = 0;        ///< index into matters()
  double tool = 0;          ///< index into tool_names()
  double radius = 0.08;     ///< m, of the brush
  double strength = 1;      ///< of the brush
  double drop = 0;          ///< index into drop_names()
  double compare_with = 0;  ///< 0: the same; from 1 on an index into matters(), plus 1
  // Of the picture.
  double look = 0;      ///< index into look_choices()
  double color_by = 0;  ///< index into color_choices()
  double random_colors = 0;
  double dark = 0;
  double outline = 1;
  double scale_bar = 1;

  bool operator==(const Settings&) const = default;
};

/// A setting that is a member of Settings.
struct SettingControl {
  ControlInfo info;
  double Settings::* member;
  bool of_world;  ///< whether it changes what happens, and not only how it is seen or worked on
};
const std::vector<SettingControl>& setting_controls();

const std::vector<std::string>& tool_names();
/// The keys that choose them, in their order.
std::string_view tool_keys();
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
