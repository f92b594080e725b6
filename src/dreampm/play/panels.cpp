#include "dreampm/play/panels.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dreampm/gl/color_scale.h"
#include "dreampm/play/matter.h"
#include "dreampm/play/stories.h"

namespace dreampm::play {
namespace {

constexpr float panel_width = 310, strip_height = 98;

ImU32 color_of(const Vec3f& c, float alpha = 1) { return ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, alpha}); }

/// Of the ten kinds of matter, for their buttons.
Vec3f button_color(std::size_t kind) {
  static const Vec3f colors[] = {{0.25f, 0.55f, 0.85f}, {0.90f, 0.60f, 0.12f}, {0.42f, 0.29f, 0.18f},
                                 {0.84f, 0.20f, 0.33f}, {0.18f, 0.44f, 0.78f}, {0.93f, 0.95f, 0.98f},
                                 {0.84f, 0.68f, 0.44f}, {0.50f, 0.50f, 0.52f}, {0.72f, 0.92f, 0.88f},
                                 {0.92f, 0.90f, 0.84f}};
  return colors[kind % std::size(colors)];
}

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

/// A file that is not there yet; blanks would part words.
std::string free_name(std::string story) {
  std::replace(story.begin(), story.end(), ' ', '-');
  for (int n = 1;; ++n)
    if (std::string name = fmt::format("{}-{:03}.yaml", story, n); !std::filesystem::exists(name)) return name;
}

std::string value_text(double value) {
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-3 || size >= 1e5)) return fmt::format("{:.2e}", value);
  return fmt::format("{:.4g}", value);
}

}  // namespace

const std::vector<KeyHelp>& key_help() {
  static const std::vector<KeyHelp> all{
      {"move", "push matter"},
      {"left drag on matter", "the chosen tool; push and grab take hold"},
      {"left drag elsewhere", "turn the view"},
      {"right drag, wheel", "shift the view, come nearer"},
      {"1 ... 0", "choose matter"},
      {"hold P", "pour it where the pointer is"},
      {"Q G O D C E N", "tools: push, grab, pour, drop, cut, erase, pin"},
      {"[ ]", "smaller, larger brush"},
      {"arrows", "shake the box"},
      {"Space, .", "pause, one step"},
      {"R", "begin anew"},
      {"Ctrl Z, Ctrl Y", "undo, redo"},
      {"F", "the first view again"},
      {"B", "dark or light"},
      {"Tab", "hide the panels"},
      {"F12", "save a picture"},
      {"F1", "this page"},
  };
  return all;
}

Layout Panels::layout(float width, float height) const {
  if (!shown || width < 1.6f * panel_width * scale || height < 2 * strip_height * scale) return {};
  return {panel_width * scale, strip_height * scale};
}

void Panels::note_place(std::string what) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  places_.push_back({std::move(what), from.x, from.y, to.x, to.y});
}

void Panels::set(const std::string& id, double value) { asked_[id] = {value, post("set", {id, text_of(value)})}; }

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
    meters(frame, facts, width);
    legend(frame, width, height);
    hints(frame, width, height);
  }
  if (help) help_page();
}

void Panels::left_panel(const Frame& frame, float width, float height) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({width, height});
  ImGui::Begin("controls", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  matter_buttons(frame);
  ImGui::Spacing();
  tool_buttons(frame);
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
  if (section("Time", true)) controls_of(frame, "Time");
  if (section("Picture", true)) controls_of(frame, "Picture");
  ImGui::End();
}

void Panels::matter_buttons(const Frame& frame) {
  ImGui::TextUnformatted("Matter");
  const double chosen = asked(frame, "matter", frame.settings.matter);
  const float side = (ImGui::GetContentRegionAvail().x - 4 * ImGui::GetStyle().ItemSpacing.x) / 5;
  for (std::size_t kind = 0; kind < matters().size(); ++kind) {
    const Matter& m = matters()[kind];
    ImGui::PushID(static_cast<int>(kind));
    if (kind % 5 != 0) ImGui::SameLine();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = side * 1.02f;
    if (ImGui::InvisibleButton("matter", {side, height})) set("matter", static_cast<double>(kind));
    note_place(fmt::format("set matter {}", kind));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const bool is_chosen = static_cast<std::size_t>(chosen) == kind, hovered = ImGui::IsItemHovered();
    list.AddRectFilled(at, {at.x + side, at.y + height},
                       ImGui::GetColorU32(is_chosen ? ImGuiCol_ButtonActive
                                          : hovered ? ImGuiCol_ButtonHovered
                                                    : ImGuiCol_FrameBg),
                       6 * scale);
    ball(list, {at.x + side / 2, at.y + 0.40f * height}, 0.27f * side, button_color(kind));
    const std::string title(m.title);
    const float size = ImGui::GetFontSize() * 0.72f;
    const ImVec2 text = ImGui::GetFont()->CalcTextSizeA(size, 1e9f, 0, title.c_str());
    list.AddText(ImGui::GetFont(), size, {at.x + (side - text.x) / 2, at.y + 0.74f * height},
                 ImGui::GetColorU32(ImGuiCol_Text), title.c_str());
    const std::string key(1, m.key);
    list.AddText(ImGui::GetFont(), size * 0.9f, {at.x + 4 * scale, at.y + 2 * scale},
                 ImGui::GetColorU32(ImGuiCol_TextDisabled), key.c_str());
    ImGui::PopID();
  }
}

void Panels::tool_buttons(const Frame& frame) {
  ImGui::TextUnformatted("Tool");
  static constexpr std::string_view keys = "QGODCEN";
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
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("key %c", keys[t]);
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
    set("gravity.y", -std::sqrt(std::max(0.0, 9.81 * 9.81 - x * x - z * z)));
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
    set("gravity.x", 0), set("gravity.y", -9.81), set("gravity.z", 0);
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
      control(c, asked(frame, c.id, frame.values[i]));
    }
  }
}

void Panels::control(const ControlInfo& c, double value) {
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
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.55f);
    double edited = value;
    const ImGuiSliderFlags flags = (c.decades ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp |
                                   ImGuiSliderFlags_NoRoundToFormat;
    const bool changed = ImGui::SliderScalar(c.label.c_str(), ImGuiDataType_Double, &edited, &c.min, &c.max,
                                             value_text(value).c_str(), flags);
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
      set(c.id, c.fallback), ImGui::ClearActiveID();
    else if (changed && edited != value)
      set(c.id, std::clamp(edited, c.min, c.max));
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
  if (ImGui::Button("Save")) post("save", {free_name(frame.story)});
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene file that dreampm make runs, in this folder");
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
  for (const Story& s : stories()) {
    const bool is_open = frame.story == s.name;
    if (is_open) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::Button(std::string(s.title).c_str())) post("open", {std::string(s.name)}), new_stage_ = true;
    note_place(fmt::format("open {}", s.name));
    if (is_open) ImGui::PopStyleColor();
    ImGui::SameLine();
  }
  for (int preset = 1; preset <= 2; ++preset) {
    if (ImGui::Button(fmt::format("Report {}", preset).c_str()))
      post("open", {"report", std::to_string(preset)}), new_stage_ = true;
    note_place(fmt::format("open report {}", preset));
    ImGui::SameLine();
  }
  if (new_stage_ && frame.story != story_) pointer.reset_camera(frame), new_stage_ = false;
  story_ = frame.story;
  ImGui::End();
}

void Panels::meters(const Frame& frame, const DrawingFacts& facts, float width) {
  ImGui::SetNextWindowPos({width - 10 * scale, 10 * scale}, 0, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin("meters", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs);
  const Meters& m = frame.meters;
  ImGui::Text("%s  t = %.3f s", frame.story.c_str(), frame.time);
  ImGui::Text("%zu particles, %d substeps of %.2f ms", frame.particles, m.substeps, m.step_ms);
  ImGui::Text("dt asked %.3g ms, taken %.3g ms (%s)", 1e3 * m.asked_dt, 1e3 * m.taken_dt, m.limiter.c_str());
  if (!m.remedy.empty()) ImGui::TextDisabled("longer: %s", m.remedy.c_str());
  ImGui::Text("%.0f %% of the pace asked for", 100 * m.rate);
  ImGui::Text("%.0f frames a second, drawing %.1f ms (%s)", facts.frames_a_second, facts.draw_ms,
              std::string(facts.look).c_str());
  ImGui::TextDisabled("%d threads, %s", facts.threads, facts.isa.c_str());
  if (frame.message_number != message_seen_)
    message_seen_ = frame.message_number, message_until_ = ImGui::GetTime() + 6;
  if (ImGui::GetTime() < message_until_) {
    ImGui::PushTextWrapPos(340 * scale);
    ImGui::TextColored({0.95f, 0.55f, 0.2f, 1}, "%s", frame.message.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

void Panels::legend(const Frame& frame, float width, float height) {
  if (frame.value_label.empty()) return;
  const Layout l = layout(width, height);
  ImGui::SetNextWindowPos({width - 10 * scale, height - l.bottom - 10 * scale}, 0, {1, 1});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin("legend", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs);
  ImGui::Text("%s%s%s%s", frame.value_label.c_str(), frame.value_unit.empty() ? "" : " [", frame.value_unit.c_str(),
              frame.value_unit.empty() ? "" : "]");
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float wide = 220 * scale, high = 12 * scale;
  constexpr int parts = 64;
  for (int i = 0; i < parts; ++i)
    ImGui::GetWindowDrawList()->AddRectFilled({at.x + wide * static_cast<float>(i) / parts, at.y},
                                              {at.x + wide * static_cast<float>(i + 1) / parts, at.y + high},
                                              color_of(gl::color_scale((static_cast<float>(i) + 0.5f) / parts)));
  ImGui::Dummy({wide, high});
  const std::string low = value_text(static_cast<double>(frame.value_min)),
                    top = value_text(static_cast<double>(frame.value_max));
  ImGui::TextUnformatted(low.c_str());
  ImGui::SameLine(wide - ImGui::CalcTextSize(top.c_str()).x);
  ImGui::TextUnformatted(top.c_str());
  ImGui::End();
}

void Panels::hints(const Frame& frame, float width, float height) {
  // They fade in the first half minute.
  const auto age = static_cast<float>(ImGui::GetTime());
  const float alpha = std::clamp((24 - age) / 4, 0.0f, 1.0f);
  if (alpha <= 0) return;
  const Layout l = layout(width, height);
  const char* const lines[] = {"move the pointer through the matter to push it",
                               "drag matter to grab it, drag elsewhere to turn the view",
                               "hold P to pour; F1 shows all keys"};
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  float y = height - l.bottom - 70 * scale;
  for (const char* line : lines) {
    const ImVec2 size = ImGui::CalcTextSize(line);
    const float x = l.left + (width - l.left - size.x) / 2;
    list.AddText({x, y}, color_of(frame.settings.dark != 0 ? Vec3f{1, 1, 1} : Vec3f{0.1f, 0.15f, 0.2f}, alpha), line);
    y += 1.3f * size.y;
  }
}

void Panels::help_page() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, 0, {0.5f, 0.5f});
  ImGui::Begin("Keys", &help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2)) {
    for (const KeyHelp& k : key_help()) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(std::string(k.keys).c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(std::string(k.what).c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace dreampm::play
