#include "dreampm/play/panels/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/base/file.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/play/panels/imgui_text.h"

namespace dreampm::play {
namespace {

constexpr float panel_width = 310;
/// Of the strip: with its buttons, the rewind bar and stories in one row each, and a further row.
constexpr float strip_height = 122, strip_row = 35;
/// What buttons and the rewind bar take beside each other, and the buttons alone.
constexpr float all_in_a_row = 830, buttons_in_a_row = 560;

/// A shaded ball.
void ball(ImDrawList& list, ImVec2 middle, float radius, const Vec3f& color) {
  constexpr int rings = 6;
  for (int i = 0; i < rings; ++i) {
    const float t = static_cast<float>(i) / rings, light = 0.62f + 0.55f * t;
    const Vec3f c{std::min(color.x * light, 1.0f), std::min(color.y * light, 1.0f), std::min(color.z * light, 1.0f)};
    list.AddCircleFilled({middle.x - 0.28f * radius * t, middle.y - 0.30f * radius * t}, radius * (1 - 0.8f * t),
                         color_of(c), 32);
  }
}

}  // namespace

float scale_of_size(int width, int height) {
  const float fits = std::min(static_cast<float>(width) / 1920, static_cast<float>(height) / 1080);
  return std::clamp(std::floor(4 * fits) / 4, 1.0f, 4.0f);
}

Layout Panels::layout(float width, float height) const {
  if (!shown || width < 1.6f * panel_width * scale || height < 2.6f * strip_height * scale) return {};
  const float room = width - panel_width * scale;
  const int more = room >= all_in_a_row * scale ? 0 : room >= buttons_in_a_row * scale ? 1 : 2;
  // Stories are lower where there is little room.
  const float high = more < 2 ? strip_height + static_cast<float>(more) * strip_row : strip_height + 1.4f * strip_row;
  return {panel_width * scale, high * scale};
}

bool Panels::is_narrow(const Frame& frame, float width, float height) const {
  const float picture = width - layout(width, height).left;
  return picture < 640 * scale || (frame.other && picture < 960 * scale);
}

void Panels::note_place(std::string what) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  places_.push_back({std::move(what), from.x, from.y, to.x, to.y});
}

void Panels::set(const std::string& id, double value) {
  asked_[id] = {value, post("set", {id, text_of(value)})};
  edits_ = edits_ || id.starts_with("material.") || id.starts_with("gravity.");
}

double Panels::asked(const Frame& frame, const std::string& id, double value) {
  const auto it = asked_.find(id);
  if (it == asked_.end()) return value;
  if (frame.actions < it->second.number) return it->second.value;
  asked_.erase(it);
  return value;
}

void Panels::draw(const Frame& frame, Cursor& pointer, const DrawingFacts& facts, float width, float height) {
  const Layout l = layout(width, height);
  places_.clear();
  take_message(frame);
  const float top = (frame.other ? 52.0f : 12.0f) * scale;
  if (l.left > 0) {
    left_panel(frame, l.left, height);
    bottom_strip(frame, pointer, width, height);
    meters(frame, facts, width, height);
    hints(width, height, facts.film_seconds ? top + 26 * scale : top);
  }
  scale_bar(frame, pointer, width, height);
  message(frame, width, height);
  legend(frame, width, height);
  if (frame.other) compare_labels(frame, width, height);
  film_mark(facts, width, height, top);
  render_progress(frame, width, height);
  render_dialog(frame, pointer);
  closing_dialog(frame);
  if (help) help_page();
  // What the hand does next is an edit of its own.
  if (edits_ && !ImGui::IsAnyItemActive()) post("done"), edits_ = false;
}

void Panels::left_panel(const Frame& frame, float width, float height) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({width, height});
  if (by_keyboard && !was_by_keyboard_) ImGui::SetNextWindowFocus();
  was_by_keyboard_ = by_keyboard;
  ImGui::Begin("controls", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  matter_buttons(frame);
  ImGui::Spacing();
  tool_buttons(frame);
  buttons_of_tools(frame);
  ImGui::Spacing();
  const auto section = [&](const std::string& name, bool open) {
    const bool is_open = ImGui::CollapsingHeader(name.c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    note_place("heading " + name);
    return is_open;
  };
  if (section("Hand", true)) controls_of(frame, "Hand");
  const bool report = std::any_of(frame.controls->begin(), frame.controls->end(),
                                  [](const ControlInfo& c) { return c.panel == "Report"; });
  if (report && section("Report", true)) look_buttons(frame), controls_of(frame, "Report");
  // Panels of materials in the order of the scene; those that are there begin open.
  std::size_t m = 0;
  for (const MatterFrame& matter : frame.matter) {
    if (section(matter.name, !matter.position.empty())) {
      controls_of(frame, matter.name);
      if (m < frame.facts.size()) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", unit_text(frame.facts[m]).c_str());
        ImGui::PopTextWrapPos();
      }
    }
    ++m;
  }
  if (section("World", true)) {
    size_buttons(frame);
    solver_buttons(frame);
    gravity_ball(frame);
    controls_of(frame, "World");
  }
  if (section("Compare", true)) compare_buttons(frame);
  if (section("Time", true)) controls_of(frame, "Time");
  if (section("Picture", true)) controls_of(frame, "Picture");
  ImGui::End();
}

void Panels::buttons_of_tools(const Frame& frame) {
  for (const ToolButton& button : frame.buttons) {
    if (ImGui::Button(fmt::format("{}##of_tool", button.text).c_str())) post_(button.action);
    note_place(button.action.text());
  }
}

void Panels::size_buttons(const Frame& frame) {
  if (!frame.can_resize) return;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Particles");
  for (std::size_t n = 0; n < size_names().size(); ++n) {
    ImGui::SameLine();
    const bool is_chosen = frame.size == n;
    if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::Button(fmt::format("{}##size", size_names()[n]).c_str())) post("size", {size_names()[n]});
    note_place("size " + size_names()[n]);
    if (is_chosen) ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("begins anew; key M for the next");
  }
}

void Panels::solver_buttons(const Frame& frame) {
  static constexpr std::array<const char*, 2> meaning{
      "short steps, as sound asks for, of all matter",
      "large steps of liquids, whose volume a pressure keeps, and of what lies in them"};
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Solver");
  for (std::size_t n = 0; n < solver_names().size(); ++n) {
    ImGui::SameLine();
    const bool is_chosen = frame.solver == n, is_off = !is_chosen && !frame.no_other.empty();
    if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (is_off) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.45f * ImGui::GetStyle().Alpha);
    if (ImGui::Button(fmt::format("{}##solver", solver_names()[n]).c_str()) && !is_chosen && !is_off)
      post("solver", {solver_names()[n]});
    note_place("solver " + solver_names()[n]);
    if (is_chosen) ImGui::PopStyleColor();
    if (is_off) ImGui::PopStyleVar();
    if (!ImGui::IsItemHovered()) continue;
    if (is_off)
      ImGui::SetTooltip("%s", frame.no_other.c_str());
    else
      ImGui::SetTooltip("%s; begins anew; key %c", meaning[n], solver_key);
  }
}

void Panels::tool_buttons(const Frame& frame) {
  ImGui::TextUnformatted("Tool");
  const auto chosen = static_cast<std::size_t>(asked(frame, "tool", static_cast<double>(frame.settings.tool)));
  const std::size_t count = tool_names().size();
  for (std::size_t t = 0; t < count; ++t) {
    if (t % 4 != 0) ImGui::SameLine();
    const bool is_chosen = chosen == t;
    if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const float width = (ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x -
                         3 * ImGui::GetStyle().ItemSpacing.x) /
                        4;
    if (ImGui::Button(fmt::format("{}##tool", tool_names()[t]).c_str(), {width, 0}))
      set("tool", static_cast<double>(t));
    note_place(fmt::format("set tool {}", t));
    if (is_chosen) ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("key %c", play::tool_buttons()[t].key);
  }
}

/// The direction of gravity as a ball that rolls that way: a drag tilts the box.
void Panels::gravity_ball(const Frame& frame) {
  const float radius = 34 * scale;
  const ImVec2 at = ImGui::GetCursorScreenPos(), middle{at.x + radius + 4, at.y + radius};
  ImGui::InvisibleButton("gravity", {2 * radius + 8, 2 * radius});
  note_place("tilt");
  const double gx = asked(frame, "gravity.x", frame.settings.gravity_x),
               gz = asked(frame, "gravity.z", frame.settings.gravity_z);
  constexpr double most = 9.8;
  if (ImGui::IsItemActive()) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    double x = (mouse.x - middle.x) / radius * most, z = (mouse.y - middle.y) / radius * most;
    if (const double size = std::hypot(x, z); size > most) x *= most / size, z *= most / size;
    set("gravity.x", x), set("gravity.z", z);
    // It is turned and keeps its strength; where there is none it is the earth's.
    const double gy = asked(frame, "gravity.y", frame.settings.gravity_y), size = std::hypot(gx, gy, gz);
    const double strength = size > 0 ? size : 9.81, down = std::max(0.0, strength * strength - x * x - z * z);
    set("gravity.y", gy > 0 ? std::sqrt(down) : -std::sqrt(down));
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
    for (const ControlInfo& c : *frame.controls)
      if (c.id.starts_with("gravity.")) set(c.id, c.fallback);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("drag to tilt the box; double click: upright");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(middle, radius, ImGui::GetColorU32(ImGuiCol_FrameBg), 48);
  list.AddCircle(middle, radius, ImGui::GetColorU32(ImGuiCol_Border), 48);
  ball(list,
       {middle.x + static_cast<float>(gx / most) * radius * 0.8f,
        middle.y + static_cast<float>(gz / most) * radius * 0.8f},
       9 * scale, {0.35f, 0.6f, 0.95f});
  ImGui::SameLine();
  ImGui::TextWrapped("tilt: drag the ball\nshake: arrow keys");
}

}  // namespace dreampm::play
