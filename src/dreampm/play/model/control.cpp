#include "dreampm/play/model/control.h"

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

const std::vector<std::string> off_on{"off", "on"};

}  // namespace

const std::vector<std::string>& tool_names() {
  static const std::vector<std::string> names{"push", "grab", "pour", "drop", "cut", "erase", "pin", "walls"};
  return names;
}
std::string_view tool_keys() { return "QGODCENW"; }
const std::vector<std::string>& look_choices() {
  static const std::vector<std::string> names{"automatic", "points", "spheres", "matter"};
  return names;
}
const std::vector<std::string>& color_choices() {
  static const std::vector<std::string> names{"material", "speed", "pressure", "J", "Jp", "age"};
  return names;
}

const std::vector<SettingControl>& setting_controls() {
  static const Settings start;
  // id, panel, label, unit, help, min, max, fallback, decades, choices
  static const std::vector<SettingControl> all{
      {{"paused", "Time", "Pause", "", "time stands still; Space", 0, 1, start.paused, false, off_on},
       &Settings::paused,
       false},
      {{"speed", "Time", "Playback speed", "x",
        "simulated seconds a second; slower shows more, and changes nothing else", 1.0 / 64, 1, start.speed, true},
       &Settings::speed,
       false},
      {{"cfl", "Time", "Cells in a step", "",
        "that most matter crosses in a large step: 1 keeps more of a splash, 3 is faster; small ones show more",
        least_cfl, largest_projection_cfl, start.cfl},
       &Settings::cfl,
       true},
      {{"time_step", "Report", "Time Step", "x 1e-4 s",
        "asked for each of the 25 substeps of a drawn frame; what is taken is what the matter can take", 0, 4,
        start.time_step},
       &Settings::time_step,
       false},
      {{"auto_restart", "Report", "Auto Restart", "",
        "on: a change of the material begins anew; off: it forgets the deformation, and goes on where it is", 0, 1,
        start.auto_restart, false, off_on},
       &Settings::auto_restart,
       false},
      {{"gravity.x", "World", "Gravity x", "m/s^2", "to the right", -10, 10, start.gravity_x},
       &Settings::gravity_x,
       true},
      {{"gravity.y", "World", "Gravity y", "m/s^2", "up; the earth's is -9.81", -10, 10, start.gravity_y},
       &Settings::gravity_y,
       true},
      {{"gravity.z", "World", "Gravity z", "m/s^2", "to the front", -10, 10, start.gravity_z},
       &Settings::gravity_z,
       true},
      {{"matter", "Matter", "Matter", "", "what is poured and dropped; keys 1 to 0", 0,
        static_cast<double>(matters().size() - 1), start.matter, false, matter_titles()},
       &Settings::matter,
       false},
      {{"tool", "Hand", "Tool", "", "what a drag with the left button does", 0,
        static_cast<double>(tool_names().size() - 1), start.tool, false, tool_names()},
       &Settings::tool,
       false},
      {{"radius", "Hand", "Brush radius", "m", "of the ring under the cursor", 0.02, 0.3, start.radius, true},
       &Settings::radius,
       false},
      {{"strength", "Hand", "Brush strength", "", "how firmly the brush takes matter along", 0.1, 10, start.strength,
        true},
       &Settings::strength,
       false},
      {{"drop", "Hand", "Drop a", "",
        "what the tool drop lets fall: crate, brick and ball are rigid, the others of the chosen matter", 0,
        static_cast<double>(drop_names().size() - 1), start.drop, false, drop_names()},
       &Settings::drop,
       false},
      {{"compare_with", "Compare", "Side B", "", "what takes the place of the main matter there", 0,
        static_cast<double>(matters().size()), start.compare_with, false, compare_choices()},
       &Settings::compare_with,
       false},
      {{"look", "Picture", "Look", "", "automatic: the best that this machine draws in time", 0,
        static_cast<double>(look_choices().size() - 1), start.look, false, look_choices()},
       &Settings::look,
       false},
      {{"color_by", "Picture", "Color by", "", "material, or a number with its scale", 0,
        static_cast<double>(color_choices().size() - 1), start.color_by, false, color_choices()},
       &Settings::color_by,
       false},
      {{"random_colors", "Picture", "Use Random Colors", "", "each particle in a color of its own", 0, 1,
        start.random_colors, false, off_on},
       &Settings::random_colors,
       false},
      {{"dark", "Picture", "Dark", "", "a dark background", 0, 1, start.dark, false, off_on}, &Settings::dark, false},
      {{"scale_bar", "Picture", "Scale bar", "", "a length, at the depth of the middle of the box", 0, 1,
        start.scale_bar, false, off_on},
       &Settings::scale_bar,
       false},
      {{"outline", "Picture", "Edges of the box", "", "", 0, 1, start.outline, false, off_on},
       &Settings::outline,
       false},
  };
  return all;
}

}  // namespace dreampm::play
