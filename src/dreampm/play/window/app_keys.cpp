// What keys do, and files that are dropped into the window.
#include <imgui.h>

#include <algorithm>
#include <array>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/open_file.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/tools/drop.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/play/window/app_impl.h"

namespace dreampm::play {
namespace {

/// m/s^2, of an arrow key.
constexpr double shake_strength = 12;

}  // namespace

/// What a key does, beside those of matter and tools.
struct App::Impl::Binding {
  int key;
  bool control;  ///< whether only with Ctrl; else with it too
  void (*press)(Impl&, const Frame&);
  bool repeats = false;  ///< whether it goes on while the key is held
};

const std::vector<App::Impl::Binding>& App::Impl::bindings() {
  const auto code = [](Key key) { return static_cast<int>(key); };
  static constexpr auto radius = [](Impl& a, const Frame& f) { return a.panels.asked(f, "radius", f.settings.radius); };
  static const std::vector<Binding> all{
      {' ', false, [](Impl& a, const Frame& f) { a.toggle(f, "paused", f.settings.paused); }},
      {'.', false,
       [](Impl& a, const Frame& f) {
         if (a.panels.asked(f, "paused", f.settings.paused) == 0) a.set("paused", 1);
         a.post({"step", {}});
       },
       true},
      {'R', false, [](Impl& a, const Frame&) { a.post({"restart", {}}); }},
      {'Z', true, [](Impl& a, const Frame&) { a.post({"undo", {}}); }, true},
      {'Y', true, [](Impl& a, const Frame&) { a.post({"redo", {}}); }, true},
      {'F', false, [](Impl& a, const Frame& f) { a.pointer.reset_camera(f); }},
      {'B', false, [](Impl& a, const Frame& f) { a.toggle(f, "dark", f.settings.dark); }},
      {'V', false, [](Impl& a, const Frame& f) { a.panels.toggle_film(f); }},
      {'L', false, [](Impl& a, const Frame& f) { a.save_last(f); }},
      {'P', false, [](Impl& a, const Frame& f) { a.pointer.hold_pour(f, true); }},
      {'[', false, [](Impl& a, const Frame& f) { a.set("radius", std::max(radius(a, f) / 1.25, 0.02)); }, true},
      {']', false, [](Impl& a, const Frame& f) { a.set("radius", std::min(radius(a, f) * 1.25, 0.3)); }, true},
      {'O', true, [](Impl& a, const Frame&) { a.panels.asks_for_file = true; }},
      {'M', false,
       [](Impl& a, const Frame& f) { a.post({"size", {size_names().at((f.size + 1) % size_names().size())}}); }},
      {solver_key, false,
       [](Impl& a, const Frame& f) {
         if (f.no_other.empty())
           a.post({"solver", {solver_names().at(1 - f.solver)}});
         else
           a.panels.tell(f.no_other, true);
       }},
      {'K', false,
       [](Impl& a, const Frame& f) {
         a.post(f.other ? Action{"compare", {"off"}} : compare_with(f.settings.compare_with));
       }},
      {'X', false,
       [](Impl& a, const Frame& f) {
         if (f.other) a.post({"compare", {"side", f.side == 'A' ? "B" : "A"}});
       }},
      {code(Key::left), false, [](Impl& a, const Frame&) { a.shake(-1, 0); }, true},
      {code(Key::right), false, [](Impl& a, const Frame&) { a.shake(1, 0); }, true},
      {code(Key::up), false, [](Impl& a, const Frame&) { a.shake(0, -1); }, true},
      {code(Key::down), false, [](Impl& a, const Frame&) { a.shake(0, 1); }, true},
      {code(Key::tab), false, [](Impl& a, const Frame&) { a.panels.shown = !a.panels.shown; }},
      {code(Key::f1), false, [](Impl& a, const Frame&) { a.panels.help = !a.panels.help; }},
      {code(Key::escape), false,
       [](Impl& a, const Frame&) {
         if (a.panels.close_menus()) return;
         a.panels.help = false;
         // The first one lets go of a slider.
         if (!ImGui::IsAnyItemActive()) a.panels.by_keyboard = false;
       }},
      {code(Key::f6), false, [](Impl& a, const Frame&) { a.panels.by_keyboard = a.panels.shown = true; }},
      {code(Key::f12), false, [](Impl& a, const Frame&) { a.wants_picture = true; }},
  };
  return all;
}

void App::Impl::shake(double x, double z) {
  post({"shake", {text_of(x * shake_strength), "0", text_of(z * shake_strength)}});
}

void App::Impl::keys(const Frame& frame, const Input& input) {
  const auto code = [](Key key) { return static_cast<int>(key); };
  const std::array<int, 6> of_controls{' ',           code(Key::left), code(Key::right),
                                       code(Key::up), code(Key::down), code(Key::tab)};
  const auto press = [&](int key, bool again) {
    if (panels.by_keyboard && std::find(of_controls.begin(), of_controls.end(), key) != of_controls.end()) return;
    for (const Binding& b : bindings())
      if (b.key == key && (input.control || !b.control) && (b.repeats || !again)) b.press(*this, frame);
  };
  for (const int key : input.repeated) press(key, true);
  for (const int key : input.pressed) {
    for (std::size_t kind = 0; kind < matters().size(); ++kind)
      if (key == matters()[kind].key) panels.choose_matter(frame, kind);
    for (std::size_t tool = 0; tool < tool_buttons().size(); ++tool)
      if (!input.control && key == tool_buttons()[tool].key) set("tool", static_cast<double>(tool));
    press(key, false);
  }
}

void App::Impl::drop_files(const Frame& under, const std::vector<std::string>& files, double x, double y) {
  const double size = 2 * under.settings.radius;
  const Hit hit =
      pick(under, pointer.seen_by().ray(static_cast<float>(x), static_cast<float>(y), scene_width, scene_height));
  const Vec3d at = above(hit, under.domain, size, under.spacing);
  for (const std::string& file : files) {
    if (kind_of_file(file) == FileKind::mesh) {
      post({"drop", {file, text_of(at.x), text_of(at.y), text_of(at.z), text_of(size)}});
      continue;
    }
    panels.open_file(file);
  }
}

}  // namespace dreampm::play
