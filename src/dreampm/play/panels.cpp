#include "dreampm/play/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "dreampm/base/file.h"
#include "dreampm/play/imgui_text.h"

namespace dreampm::play {
namespace {

constexpr float panel_width = 310, strip_height = 122;

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
  if (!shown || width < 1.6f * panel_width * scale || height < 2 * strip_height * scale) return {};
  return {panel_width * scale, strip_height * scale};
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

void Panels::draw(const Frame& frame, Pointer& pointer, const DrawingFacts& facts, float width, float height) {
  const Layout l = layout(width, height);
  places_.clear();
  if (l.left > 0) {
    left_panel(frame, l.left, height);
    bottom_strip(frame, pointer, width, height);
    meters(frame, facts, width, height);
    hints(frame, width, height);
  }
  scale_bar(frame, pointer, width, height);
  legend(frame, width, height);
  if (frame.other) compare_labels(frame, width, height);
  film_mark(facts, width, height, (frame.other ? 52.0f : 12.0f) * scale);
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
  pin_button(frame);
  ImGui::Spacing();
  const auto section = [&](const std::string& name, bool open) {
    const bool is_open = ImGui::CollapsingHeader(name.c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    note_place("heading " + name);
    return is_open;
  };
  if (section("Hand", true)) controls_of(frame, "Hand");
  const bool report = std::any_of(frame.controls->begin(), frame.controls->end(),
                                  [](const ControlInfo& c) { return c.panel == "Report"; });
  if (report && section("Report", true)) controls_of(frame, "Report");
  // Panels of materials in the order of the scene; those that are there begin open.
  std::size_t m = 0;
  for (const MatterFrame& matter : frame.matter) {
    if (section(matter.name, !matter.position.empty())) {
      controls_of(frame, matter.name);
      if (m < frame.facts.size()) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", frame.facts[m].c_str());
        ImGui::PopTextWrapPos();
      }
    }
    ++m;
  }
  if (section("World", true)) {
    gravity_ball(frame);
    controls_of(frame, "World");
  }
  if (section("Compare", true)) compare_buttons(frame);
  if (section("Time", true)) controls_of(frame, "Time");
  if (section("Picture", true)) controls_of(frame, "Picture");
  ImGui::End();
}

void Panels::pin_button(const Frame& frame) {
  if (frame.pins.empty()) return;
  if (ImGui::Button(fmt::format("let {} go##pins", frame.pins.size() == 1 ? "the pin" : "all pins").c_str()))
    post("pin", {"off"});
  note_place("pin off");
}

void Panels::tool_buttons(const Frame& frame) {
  ImGui::TextUnformatted("Tool");
  const double chosen = asked(frame, "tool", frame.settings.tool);
  const std::size_t count = tool_names().size();
  for (std::size_t t = 0; t < count; ++t) {
    if (t % 4 != 0) ImGui::SameLine();
    const bool is_chosen = static_cast<std::size_t>(chosen) == t;
    if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const float width = (ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x -
                         3 * ImGui::GetStyle().ItemSpacing.x) /
                        4;
    if (ImGui::Button(fmt::format("{}##tool", tool_names()[t]).c_str(), {width, 0}))
      set("tool", static_cast<double>(t));
    note_place(fmt::format("set tool {}", t));
    if (is_chosen) ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("key %c", tool_keys()[t]);
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

void Panels::controls_of(const Frame& frame, const std::string& panel) {
  for (std::size_t i = 0; i < frame.controls->size(); ++i) {
    const ControlInfo& c = (*frame.controls)[i];
    // Tools have buttons.
    if (!c.color.empty() && c.panel == panel) {
      float rgb[3];
      for (std::size_t k = 0; k < 3; ++k)
        rgb[k] = static_cast<float>(asked(frame, (*frame.controls)[i + k].id, frame.values[i + k]));
      // Colors of several materials bear the same label.
      ImGui::PushID(c.color.c_str());
      if (ImGui::ColorEdit3(c.label.c_str(), rgb, ImGuiColorEditFlags_NoInputs))
        for (std::size_t k = 0; k < 3; ++k) set((*frame.controls)[i + k].id, static_cast<double>(rgb[k]));
      ImGui::PopID();
      note_place(c.color);
      i += 2;
    } else if (c.panel == panel && c.id != "tool") {
      const auto other = std::find_if(frame.controls->begin(), frame.controls->end(),
                                      [&](const ControlInfo& o) { return o.id == c.needs; });
      const bool is_idle =
          other != frame.controls->end() &&
          (asked(frame, other->id, frame.values[static_cast<std::size_t>(other - frame.controls->begin())]) == 0) !=
              c.needs_off;
      if (is_idle) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.45f * ImGui::GetStyle().Alpha);
      control(c, asked(frame, c.id, frame.values[i]), frame.live[i]);
      if (is_idle) ImGui::PopStyleVar();
    }
  }
}

void Panels::mark_live(const ControlInfo& c, const LiveRange& live, float wide) {
  const bool log = c.decades && c.min > 0;
  const auto at = [&](double x) {
    return static_cast<float>(log ? std::log(x / c.min) / std::log(c.max / c.min) : (x - c.min) / (c.max - c.min));
  };
  const ImVec2 from = ImGui::GetItemRectMin();
  const float low = from.y, high = ImGui::GetItemRectMax().y, rounding = ImGui::GetStyle().FrameRounding;
  constexpr ImU32 red = IM_COL32(220, 50, 40, 110);
  const auto mark = [&](float left, float right) {
    ImGui::GetWindowDrawList()->AddRectFilled({from.x + left * wide, low}, {from.x + right * wide, high}, red,
                                              rounding);
  };
  if (live.min > c.min) mark(0, at(live.min));
  if (live.max < c.max) mark(at(live.max), 1);
}

void Panels::control(const ControlInfo& c, double value, const LiveRange& live) {
  ImGui::PushID(c.id.c_str());
  if (c.is_switch()) {
    bool on = value != 0;
    if (ImGui::Checkbox(c.label.c_str(), &on)) set(c.id, on ? 1 : 0);
  } else if (!c.choices.empty()) {
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.55f);
    const auto at = static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(c.choices.size() - 1)));
    if (ImGui::BeginCombo(c.label.c_str(), c.choices[at].c_str())) {
      for (std::size_t n = 0; n < c.choices.size(); ++n)
        if (ImGui::Selectable(c.choices[n].c_str(), n == at)) set(c.id, static_cast<double>(n));
      ImGui::EndCombo();
    }
  } else {
    const float wide = ImGui::GetContentRegionAvail().x * 0.55f;
    ImGui::SetNextItemWidth(wide);
    double edited = value;
    const ImGuiSliderFlags flags = (c.decades ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp |
                                   ImGuiSliderFlags_NoRoundToFormat;
    const bool changed = ImGui::SliderScalar(c.label.c_str(), ImGuiDataType_Double, &edited, &c.min, &c.max,
                                             value_text(value).c_str(), flags);
    if (ImGui::IsItemActivated()) held_ = live, holds_ = false;
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
      set(c.id, c.fallback), ImGui::ClearActiveID();
    else if (changed && edited != value) {
      // From where it stands, wherever that is, it goes on.
      const double wanted = std::clamp(edited, c.min, c.max);
      const double held = std::clamp(wanted, std::min(held_.min, value), std::max(held_.max, value));
      holds_ = held != wanted && !ImGui::GetIO().KeyShift;
      if (const double next = holds_ ? held : wanted; next != value) set(c.id, next);
    }
    mark_live(c, live, wide);
    if (holds_ && ImGui::IsItemActive())
      ImGui::SetTooltip("as %s as is live: further, time runs at less than a quarter of its pace.\nShift lets it go on",
                        c.id.ends_with("modulus") ? "stiff" : "far");
  }
  note_place(c.id);
  if (ImGui::BeginPopupContextItem("about")) {
    ImGui::Text("%s", c.help.c_str());
    if (c.choices.empty())
      ImGui::Text("%s to %s %s", value_text(c.min).c_str(), value_text(c.max).c_str(), c.unit.c_str());
    ImGui::TextDisabled("in scripts: set %s %s", c.id.c_str(), value_text(value).c_str());
    if (ImGui::Selectable("reset")) set(c.id, c.fallback);
    ImGui::EndPopup();
  }
  if (ImGui::IsItemHovered() && !c.help.empty() && ImGui::GetCurrentContext()->HoveredIdTimer > 0.6f)
    ImGui::SetTooltip("%s%s%s%s", c.help.c_str(), c.unit.empty() ? "" : " [", c.unit.c_str(),
                      c.unit.empty() ? "" : "]");
  ImGui::PopID();
}

void Panels::bottom_strip(const Frame& frame, Pointer& pointer, float width, float height) {
  const Layout l = layout(width, height);
  ImGui::SetNextWindowPos({l.left, height - l.bottom});
  ImGui::SetNextWindowSize({width - l.left, l.bottom});
  ImGui::Begin("strip", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_HorizontalScrollbar);
  const bool paused = asked(frame, "paused", frame.settings.paused) != 0;
  if (ImGui::Button(paused ? "Play" : "Pause", {72 * scale, 0})) set("paused", paused ? 0 : 1);
  note_place(paused ? "set paused 0" : "set paused 1");
  ImGui::SameLine();
  if (ImGui::Button("Step")) {
    if (!paused) set("paused", 1);
    post("step");
  }
  note_place("step");
  ImGui::SameLine();
  if (ImGui::Button("Restart")) post("restart");
  note_place("restart");
  ImGui::SameLine();
  const auto gray = [](bool off) {
    if (off) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.4f);
    return off;
  };
  const bool no_undo = gray(!frame.can_undo);
  if (ImGui::Button("Undo") && !no_undo) post("undo");
  note_place("undo");
  if (no_undo) ImGui::PopStyleVar();
  ImGui::SameLine();
  const bool no_redo = gray(!frame.can_redo);
  if (ImGui::Button("Redo") && !no_redo) post("redo");
  note_place("redo");
  if (no_redo) ImGui::PopStyleVar();
  ImGui::SameLine();
  if (ImGui::Button("Save")) post("save", {free_name(without_blanks(frame.story), ".yaml").string()});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene file that dreampm make runs, in this folder");
  ImGui::SameLine();
  if (ImGui::Button("Render...")) open_render(frame, pointer);
  note_place("render");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a film of this at 8 times the particles, made in the background");
  ImGui::SameLine();
  film_button(frame);
  ImGui::SameLine();
  ImGui::TextUnformatted("Rewind");
  ImGui::SameLine();
  // From the oldest moment that is kept to the latest.
  ImGui::SetNextItemWidth(std::max(80.0f, ImGui::GetContentRegionAvail().x));
  auto at = frame.future > 0 ? static_cast<float>(-frame.future) : 0.0f;
  const auto oldest = static_cast<float>(-(frame.past + frame.future));
  if (oldest < 0) {
    if (ImGui::SliderFloat("##rewind", &at, oldest, 0, "%.1f s")) {
      if (!paused) set("paused", 1);
      post("seek", {text_of(-at)});
    }
    note_place("seek");
  } else {
    ImGui::TextDisabled("the past comes");
  }
  story_buttons(frame);
  if (new_stage_ && frame.story != story_) pointer.reset_camera(frame), new_stage_ = false;
  story_ = frame.story;
  ImGui::End();
}

}  // namespace dreampm::play
