// What lies over the picture: meters, the legend of its colors, hints, and the page of keys.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "dreampm/gl/color_scale.h"
#include "dreampm/play/imgui_text.h"
#include "dreampm/play/panels.h"

namespace dreampm::play {

const std::vector<KeyHelp>& key_help() {
  static const std::vector<KeyHelp> all{
      {"move", "push matter and rigid bodies"},
      {"left drag on matter or a body", "the chosen tool; push and grab take hold"},
      {"left drag elsewhere", "turn the view"},
      {"right drag, wheel", "shift the view, come nearer; with Shift a right drag turns it"},
      {"1 ... 0", "choose matter"},
      {"hold P", "pour it where the pointer is"},
      {fmt::format("{}", fmt::join(tool_keys(), " ")), fmt::format("tools: {}", fmt::join(tool_names(), ", "))},
      {"[ ]", "smaller, larger brush"},
      {"arrows", "shake the box"},
      {"K, X", "compare with another matter; the other side"},
      {"Space, .", "pause, one step"},
      {"R", "begin anew"},
      {"Ctrl Z, Ctrl Y", "undo, redo"},
      {"F", "the first view again"},
      {"B", "dark or light"},
      {"Tab", "hide the panels"},
      {"F6", "controls by keyboard: arrows, Space; Esc ends it"},
      {"F12", "save a picture"},
      {"V", "film the picture, until V again"},
      {"L", "save the last five seconds as a film"},
      {"F1", "this page"},
  };
  return all;
}

void Panels::message(const Frame& frame, float wide) {
  if (frame.message_number != message_seen_)
    message_seen_ = frame.message_number, message_until_ = ImGui::GetTime() + 6;
  ImGui::PushTextWrapPos(wide);
  if (ImGui::GetTime() < message_until_) ImGui::TextColored({0.95f, 0.55f, 0.2f, 1}, "%s", frame.message.c_str());
  if (ImGui::GetTime() < note_until_) ImGui::TextUnformatted(note_.c_str());
  ImGui::PopTextWrapPos();
}

void Panels::note(std::string text) { note_ = std::move(text), note_until_ = ImGui::GetTime() + 6; }

void Panels::meters(const Frame& frame, const DrawingFacts& facts, float width, float height) {
  ImGui::SetNextWindowPos({width - 10 * scale, 10 * scale}, 0, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin("meters", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs);
  const Meters& m = frame.meters;
  // Where the picture is small, what is asked most, on one line.
  if (is_narrow(frame, width, height)) {
    ImGui::Text("t = %.2f s, %.0f %%", frame.time, 100 * m.rate);
    message(frame, 0.4f * (width - layout(width, height).left));
    ImGui::End();
    return;
  }
  ImGui::Dummy({320 * scale, 0});  // as wide whatever it says
  ImGui::PushTextWrapPos(340 * scale);
  ImGui::Text("%s  t = %.3f s", frame.story.c_str(), frame.time);
  ImGui::Text("%zu particles, %d substeps of %.2f ms", frame.particles, m.substeps, m.step_ms);
  ImGui::Text("dt asked %.3g ms, taken %.3g ms (%s)", 1e3 * m.asked_dt, 1e3 * m.taken_dt, m.limiter.c_str());
  if (!m.remedy.empty()) ImGui::TextDisabled("longer: %s", m.remedy.c_str());
  ImGui::Text("%.0f %% of the pace asked for", 100 * m.rate);
  if (facts.frames_a_second > 0)
    ImGui::Text("%.0f frames a second, drawing %.1f ms (%s)", facts.frames_a_second, facts.draw_ms,
                std::string(facts.look).c_str());
  ImGui::TextDisabled("%d threads, %s", facts.threads, facts.isa.c_str());
  ImGui::PopTextWrapPos();
  message(frame, 340 * scale);
  ImGui::End();
}

void Panels::legend(const Frame& frame, float width, float height) {
  if (frame.value_label.empty()) return;
  const Layout l = layout(width, height);
  ImGui::SetNextWindowPos({width - 10 * scale, height - l.bottom - 10 * scale}, 0, {1, 1});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::Begin(legend_window, nullptr,
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

RoundLength round_length(double most) {
  const double decade = std::pow(10, std::floor(std::log10(most) + 1e-9)), times = most / decade * (1 + 1e-9);
  const double meters = decade * (times >= 5 ? 5 : times >= 2 ? 2 : 1);
  const auto in = [&](double unit, const char* name) { return fmt::format("{:.4g} {}", meters / unit, name); };
  return {meters, meters >= 1 ? in(1, "m") : meters >= 0.01 ? in(0.01, "cm") : in(0.001, "mm")};
}

void Panels::scale_bar(const Frame& frame, const Pointer& pointer, float width, float height) {
  if (frame.settings.scale_bar == 0) return;
  const Layout l = layout(width, height);
  const gl::Camera camera = pointer.seen_by();
  const Vec3d to_middle = frame.domain.center() - static_cast<Vec3d>(camera.eye);
  const double depth = dot(to_middle, static_cast<Vec3d>(camera.axes().forward));
  if (!(depth > 0)) return;
  const double pixels = static_cast<double>(camera.pixels_per_slope(static_cast<int>(height - l.bottom))) / depth;
  const double wide = static_cast<double>(width - l.left) / 5;
  if (!(pixels > 0) || !(wide > 0)) return;
  const RoundLength length = round_length(wide / pixels);
  const auto long_ = static_cast<float>(length.meters * pixels);
  const ImVec2 from{l.left + 16 * scale, height - l.bottom - 14 * scale}, to{from.x + long_, from.y};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const bool dark = frame.settings.dark != 0;
  // A line of the other lightness about it: it stands before anything.
  for (const bool about : {true, false}) {
    const ImU32 color = color_of(dark == about ? Vec3f{0.05f, 0.07f, 0.1f} : Vec3f{1, 1, 1}, about ? 0.6f : 1.0f);
    const float thick = (about ? 4.5f : 2.0f) * scale, tick = (about ? 6.0f : 5.0f) * scale;
    list.AddLine(from, to, color, thick);
    for (const float x : {from.x, to.x}) list.AddLine({x, from.y - tick}, {x, from.y + tick}, color, thick);
  }
  const ImVec2 size = ImGui::CalcTextSize(length.text.c_str());
  const ImVec2 at{from.x + 0.5f * (long_ - size.x), from.y - size.y - 6 * scale};
  const auto letters = [&](float dx, float dy, bool about) {
    list.AddText({at.x + dx, at.y + dy},
                 color_of(dark == about ? Vec3f{0.05f, 0.07f, 0.1f} : Vec3f{1, 1, 1}, about ? 0.5f : 1.0f),
                 length.text.c_str());
  };
  for (const float d : {-scale, scale}) letters(d, 0, true), letters(0, d, true);
  letters(0, 0, false);
}

namespace {

/// What a beginner does not know, and the verb of who has done it.
struct Hint {
  const char* text;
  std::string_view verb;
};
constexpr std::array<Hint, 3> all_hints{{{"move the pointer through the matter to push it", "push"},
                                         {"drag matter to grab it, drag elsewhere to turn the view", "grab"},
                                         {"hold P to pour; F1 shows all keys", "pour"}}};
/// s: how long one fades, and when those go that nobody follows.
constexpr double fading = 1.5, longest_hint = 120;

}  // namespace

void Panels::note_use(std::string_view verb) {
  for (std::size_t i = 0; i < all_hints.size(); ++i)
    if (all_hints[i].verb == verb && hint_used_[i] < 0) hint_used_[i] = ImGui::GetTime();
}

void Panels::hints(const Frame& frame, float width, float height) {
  const double now = ImGui::GetTime();
  const auto alpha_of = [&](std::size_t i) {
    const double used = hint_used_[i] < 0 ? longest_hint : std::min(hint_used_[i], longest_hint);
    return static_cast<float>(std::clamp((used + fading - now) / fading, 0.0, 1.0));
  };
  const Layout l = layout(width, height);
  ImGui::SetNextWindowPos({l.left + (width - l.left) / 2, height - l.bottom - 8 * scale}, 0, {0.5f, 1});
  ImGui::Begin("hints", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing);
  const Vec3f color = frame.settings.dark != 0 ? Vec3f{1, 1, 1} : Vec3f{0.1f, 0.15f, 0.2f};
  for (std::size_t i = 0; i < all_hints.size(); ++i) {
    const float alpha = alpha_of(i);
    if (alpha > 0) ImGui::TextColored({color.x, color.y, color.z, alpha}, "%s", all_hints[i].text);
  }
  ImGui::End();
}

void Panels::help_page() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, 0, {0.5f, 0.5f});
  ImGui::Begin("Keys", &help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2)) {
    for (const KeyHelp& k : key_help()) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(k.keys.c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(k.what.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace dreampm::play
