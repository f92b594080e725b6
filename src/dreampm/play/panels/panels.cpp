#include "dreampm/play/panels/panels.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

/// The one list of panels, in the order in which they are drawn.
#define DM_PANELS(panel)                                                                                             \
  panel(matter) panel(tools) panel(brush) panel(report) panel(materials) panel(world) panel(compare) panel(time)     \
      panel(picture) /* beside the picture */ panel(strip) panel(meters) panel(hints) /* over it */ panel(scale_bar) \
          panel(messages) panel(legend) panel(side_labels) panel(film_mark) panel(render) panel(closing) panel(help)

namespace dreampm::play {
namespace {

constexpr float panel_width = 310;
/// Of the strip: with its buttons, the rewind bar and stories in one row each, and a further row.
constexpr float strip_height = 122, strip_row = 35;
/// What buttons and the rewind bar take beside each other, and the buttons alone.
constexpr float all_in_a_row = 830, buttons_in_a_row = 560;

}  // namespace

#define DM_DECLARE(name) std::unique_ptr<Panel> make_##name##_panel();
DM_PANELS(DM_DECLARE)
#undef DM_DECLARE

Panels::Panels(Cursor::Post post) : host(std::move(post)) {
#define DM_MAKE(name) panels_.push_back(make_##name##_panel());
  DM_PANELS(DM_MAKE)
#undef DM_MAKE
}

float scale_of_size(int width, int height) {
  const float fits = std::min(static_cast<float>(width) / 1920, static_cast<float>(height) / 1080);
  return std::clamp(std::floor(4 * fits) / 4, 1.0f, 4.0f);
}

Layout Panels::layout(float width, float height) const {
  const float scale = host.scale;
  if (!shown || width < 1.6f * panel_width * scale || height < 2.6f * strip_height * scale) return {};
  const float room = width - panel_width * scale;
  const int more = room >= all_in_a_row * scale ? 0 : room >= buttons_in_a_row * scale ? 1 : 2;
  // Stories are lower where there is little room.
  const float high = more < 2 ? strip_height + static_cast<float>(more) * strip_row : strip_height + 1.4f * strip_row;
  return {panel_width * scale, high * scale};
}

void Panels::draw(const Frame& frame, Cursor& cursor, const DrawingFacts& facts, float width, float height) {
  const PanelView view{frame, cursor, facts, width, height, layout(width, height)};
  host.places.clear();
  host.read_message(frame);
  if (view.layout.has_panels()) draw_left(view);
  for (const auto& panel : panels_)
    if (panel->where() == Panel::Where::over || (panel->where() == Panel::Where::beside && view.layout.has_panels()))
      panel->draw(view, host);
  // What is done next is an edit of its own.
  if (host.edits && !ImGui::IsAnyItemActive()) host.post("done"), host.edits = false;
}

void Panels::draw_left(const PanelView& view) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({view.layout.left, view.height});
  if (host.by_keyboard && !was_by_keyboard_) ImGui::SetNextWindowFocus();
  was_by_keyboard_ = host.by_keyboard;
  ImGui::Begin("controls", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  for (const auto& panel : panels_)
    if (panel->where() == Panel::Where::left) panel->draw(view, host);
  ImGui::End();
}

void Panels::note_use(std::string_view verb) {
  for (const auto& panel : panels_) panel->note_use(verb);
}

bool Panels::may_close(const Frame& frame) {
  return std::all_of(panels_.begin(), panels_.end(), [&](const auto& panel) { return panel->may_close(frame); });
}

bool Panels::asks_to_close() const {
  return std::any_of(panels_.begin(), panels_.end(), [](const auto& panel) { return panel->asks_to_close(); });
}

bool Panels::close_menus() {
  if (ImGui::GetCurrentContext()->OpenPopupStack.Size == 0) return false;
  ImGui::ClosePopupToLevel(0, true);
  return true;
}

double Panels::moves_for() const {
  const double now = ImGui::GetTime();
  double until = now;
  if (!host.notes.empty()) until = std::max(until, host.notes.back().until);
  for (const auto& panel : panels_) until = std::max(until, panel->changes_until());
  return until - now;
}

}  // namespace dreampm::play
