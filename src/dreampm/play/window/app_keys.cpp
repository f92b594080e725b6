#include "dreampm/play/window/app_keys.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <functional>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/panels/key_help.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

/// m/s^2, of an arrow key.
constexpr double shake_strength = 12;

constexpr int code(Key key) { return static_cast<int>(key); }

void shake(const KeyTarget& target, double x, double z) {
  target.post({"shake", {text_of(x * shake_strength), "0", text_of(z * shake_strength)}});
}

/// What a key does.
struct KeyBinding {
  enum class Control { any, with, without };
  int key;
  std::function<void(const KeyTarget&, const Frame&)> press;
  Control control = Control::any;
  bool repeats = false;  ///< whether it goes on while the key is held
  std::function<void(const KeyTarget&, const Frame&)> release{};
};

/// Some keys, and what they do in words. Keys stand between backticks; `page`: what the guide says
/// where that is more. Drags have no keys.
struct KeyRow {
  std::string keys, what, page{};
  std::vector<KeyBinding> bindings{};
};

/// What keys do, and in words.
const std::vector<KeyRow>& key_rows() {
  using Control = KeyBinding::Control;
  static constexpr auto radius = [](const KeyTarget& a, const Frame& f) {
    return a.panels.host.asked(f, "radius", f.settings.radius);
  };
  static const std::vector<KeyRow> all = [] {
    std::string tool_letters, tool_list, matter_list;
    std::vector<KeyBinding> of_tools, of_matter;
    KeyRow held_row;
    for (const ToolInfo& tool : tool_buttons()) {
      if (tool.held_key != 0) {
        const auto hold = [name = tool.name](bool held) {
          return [name, held](const KeyTarget& a, const Frame&) { a.cursor.hold(name, held); };
        };
        held_row = {fmt::format("hold `{}`", tool.held_key),
                    fmt::format("{} it where the pointer is", tool.name),
                    {},
                    {{tool.held_key, hold(true), Control::any, false, hold(false)}}};
      }
      const auto index = static_cast<double>(of_tools.size());
      tool_letters += fmt::format("{}`{}`", of_tools.empty() ? "" : " ", tool.key);
      tool_list += fmt::format("{}{}", of_tools.empty() ? "" : ", ", tool.name);
      of_tools.push_back(
          {tool.key, [index](const KeyTarget& a, const Frame&) { a.set("tool", index); }, Control::without});
    }
    for (const Matter& matter : matters()) {
      const std::size_t kind = of_matter.size();
      matter_list += fmt::format("{}{}", of_matter.empty() ? "" : ", ", matter.title);
      of_matter.push_back(
          {matter.key, [kind](const KeyTarget& a, const Frame& f) { a.panels.host.choose_matter(f, kind); }});
    }
    return std::vector<KeyRow>{
        {"move", "push matter and rigid bodies"},
        {"left drag on matter or a body", "the chosen tool; push and grab take hold"},
        {"left drag elsewhere", "turn the view"},
        {"right drag, wheel", "shift the view, come nearer; with Shift a right drag turns it"},
        {"`1` ... `0`", "choose matter", "choose matter: " + matter_list, of_matter},
        held_row,
        {tool_letters, "tools: " + tool_list, {}, of_tools},
        {"`[` `]`",
         "smaller, larger brush",
         {},
         {{'[', [](const KeyTarget& a, const Frame& f) { a.set("radius", std::max(radius(a, f) / 1.25, 0.02)); },
           Control::any, true},
          {']', [](const KeyTarget& a, const Frame& f) { a.set("radius", std::min(radius(a, f) * 1.25, 0.3)); },
           Control::any, true}}},
        {"arrows",
         "shake the box",
         {},
         {{code(Key::left), [](const KeyTarget& a, const Frame&) { shake(a, -1, 0); }, Control::any, true},
          {code(Key::right), [](const KeyTarget& a, const Frame&) { shake(a, 1, 0); }, Control::any, true},
          {code(Key::up), [](const KeyTarget& a, const Frame&) { shake(a, 0, -1); }, Control::any, true},
          {code(Key::down), [](const KeyTarget& a, const Frame&) { shake(a, 0, 1); }, Control::any, true}}},
        {"`K`, `X`",
         "compare with another matter; the other side",
         {},
         {{'K',
           [](const KeyTarget& a, const Frame& f) {
             a.post(f.other ? Action{"compare", {"off"}} : compare_with(f.settings.compare_with));
           }},
          {'X',
           [](const KeyTarget& a, const Frame& f) {
             if (f.other) a.post({"compare", {"side", f.side == 'A' ? "B" : "A"}});
           }}}},
        {"`Space`, `.`",
         "pause, one step",
         {},
         {{' ', [](const KeyTarget& a, const Frame& f) { a.toggle(f, "paused", f.settings.paused); }},
          {'.',
           [](const KeyTarget& a, const Frame& f) {
             if (a.panels.host.asked(f, "paused", f.settings.paused) == 0) a.set("paused", 1);
             a.post({"step", {}});
           },
           Control::any, true}}},
        {"`R`",
         "begin anew",
         "begin anew, with the materials as they are set",
         {{'R', [](const KeyTarget& a, const Frame&) { a.post({"restart", {}}); }}}},
        {"`M`",
         "fewer or more particles: small, medium, large",
         "begin anew with fewer or more particles: small, medium, large",
         {{'M', [](const KeyTarget& a,
                   const Frame& f) { a.post({"size", {size_names().at((f.size + 1) % size_names().size())}}); }}}},
        {fmt::format("`{}`", solver_key),
         "the other solver: short steps of all matter, or large ones of liquids",
         {},
         {{solver_key,
           [](const KeyTarget& a, const Frame& f) {
             if (f.no_other.empty())
               a.post({"solver", {solver_names().at(1 - f.solver)}});
             else
               a.panels.host.tell(f.no_other, true);
           }}}},
        {"`Ctrl O`",
         "open a scene, config, record or mesh",
         {},
         {{'O', [](const KeyTarget& a, const Frame&) { a.panels.host.asks_for_file = true; }, Control::with}}},
        {"`Ctrl Z`, `Ctrl Y`",
         "undo, redo",
         {},
         {{'Z', [](const KeyTarget& a, const Frame&) { a.post({"undo", {}}); }, Control::with, true},
          {'Y', [](const KeyTarget& a, const Frame&) { a.post({"redo", {}}); }, Control::with, true}}},
        {"`F`",
         "the first view again",
         {},
         {{'F', [](const KeyTarget& a, const Frame& f) { a.cursor.reset_camera(f); }}}},
        {"`B`",
         "dark or light",
         {},
         {{'B', [](const KeyTarget& a, const Frame& f) { a.toggle(f, "dark", f.settings.dark); }}}},
        {"`Tab`",
         "hide the panels",
         {},
         {{code(Key::tab), [](const KeyTarget& a, const Frame&) { a.panels.shown = !a.panels.shown; }}}},
        {"`F6`",
         "controls by keyboard: arrows, Space; Esc ends it",
         "controls without a mouse: arrows go from one to the next, `Space` takes hold of a slider or presses, arrows "
         "move it, `Esc` lets go, and then ends this",
         {{code(Key::f6), [](const KeyTarget& a, const Frame&) { a.panels.host.by_keyboard = a.panels.shown = true; }},
          {code(Key::escape),
           [](const KeyTarget& a, const Frame&) {
             if (a.panels.close_menus()) return;
             a.panels.host.help = false;
             // The first one lets go of a slider.
             if (!ImGui::IsAnyItemActive()) a.panels.host.by_keyboard = false;
           }}}},
        {"`F12`",
         "save a picture",
         "save a picture, `dreampm-001.png`, with its legend and scale",
         {{code(Key::f12), [](const KeyTarget& a, const Frame&) { a.wants_picture = true; }}}},
        {"`V`",
         "film the picture, until V again",
         "film the picture, until `V` again",
         {{'V', [](const KeyTarget& a, const Frame& f) { a.panels.host.toggle_film(f); }}}},
        {"`L`",
         "save the last five seconds as a film",
         "save the last five seconds as a film, `dam-break-last-001.mp4`, seen from where the camera stands now; the "
         "window says when it is there",
         {{'L', [](const KeyTarget& a, const Frame& f) { a.save_last(f); }}}},
        {"`F1`",
         "this page",
         "these keys",
         {{code(Key::f1), [](const KeyTarget& a, const Frame&) { a.panels.host.help = !a.panels.host.help; }}}},
    };
  }();
  return all;
}

}  // namespace

const std::vector<KeyHelp>& key_help() {
  static const std::vector<KeyHelp> all = [] {
    std::vector<KeyHelp> words;
    for (const KeyRow& row : key_rows()) {
      std::string keys = row.keys;
      std::erase(keys, '`');
      words.push_back({keys, row.what, fmt::format("| {} | {} |", row.keys, row.page.empty() ? row.what : row.page)});
    }
    return words;
  }();
  return all;
}

void press_keys(const KeyTarget& target, const Frame& frame, const Input& input) {
  using Control = KeyBinding::Control;
  const std::array<int, 6> of_controls{' ',           code(Key::left), code(Key::right),
                                       code(Key::up), code(Key::down), code(Key::tab)};
  const auto press = [&](int key, bool again) {
    if (target.panels.host.by_keyboard && std::find(of_controls.begin(), of_controls.end(), key) != of_controls.end())
      return;
    for (const KeyRow& row : key_rows())
      for (const KeyBinding& b : row.bindings)
        if (b.key == key && (b.control == Control::any || (b.control == Control::with) == input.control) &&
            (b.repeats || !again))
          b.press(target, frame);
  };
  for (const int key : input.repeated) press(key, true);
  for (const int key : input.pressed) press(key, false);
}

void release_keys(const KeyTarget& target, const Frame& frame, const Input& input) {
  for (const int key : input.released)
    for (const KeyRow& row : key_rows())
      for (const KeyBinding& b : row.bindings)
        if (b.key == key && b.release) b.release(target, frame);
}

}  // namespace dreampm::play
