// What lies over the picture: meters, the legend of its colors, hints, and the page of keys.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "dreampm/gl/color_scale.h"
#include "dreampm/play/model/playground.h"
#include "dreampm/play/tools/tool.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panels.h"

namespace dreampm::play {

namespace {

std::string keys_of_tools() {
  std::string keys;
  for (const ToolInfo& tool : tool_buttons()) keys += fmt::format("{}{}", keys.empty() ? "" : " ", tool.key);
  return keys;
}

}  // namespace

const std::vector<KeyHelp>& key_help() {
  static const std::vector<KeyHelp> all{
      {"move", "push matter and rigid bodies"},
      {"left drag on matter or a body", "the chosen tool; push and grab take hold"},
      {"left drag elsewhere", "turn the view"},
      {"right drag, wheel", "shift the view, come nearer; with Shift a right drag turns it"},
      {"1 ... 0", "choose matter"},
      {"hold P", "pour it where the pointer is"},
      {keys_of_tools(), fmt::format("tools: {}", fmt::join(tool_names(), ", "))},
      {"[ ]", "smaller, larger brush"},
      {"arrows", "shake the box"},
      {"K, X", "compare with another matter; the other side"},
      {"Space, .", "pause, one step"},
      {"R", "begin anew"},
      {"M", "fewer or more particles: small, medium, large"},
      {std::string(1, solver_key), "the other solver: short steps of all matter, or large ones of liquids"},
      {"Ctrl O", "open a scene, config, record or mesh"},
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

namespace {

/// s: how long a message stands, and how many are kept to be read again.
constexpr double message_stands = 8;
constexpr std::size_t kept_messages = 5;
constexpr ImGuiWindowFlags overlay = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoFocusOnAppearing;

void text_in(bool is_error, const std::string& text) {
  if (is_error)
    ImGui::TextColored({0.85f, 0.36f, 0.08f, 1}, "%s", text.c_str());
  else
    ImGui::TextUnformatted(text.c_str());
}

}  // namespace

void Panels::tell(std::string what, bool is_error) {
  if (!notes_.empty() && notes_.back().text == what) notes_.pop_back();
  notes_.push_back({std::move(what), is_error, ImGui::GetTime() + message_stands});
  if (notes_.size() > kept_messages) notes_.erase(notes_.begin());
}

void Panels::take_message(const Frame& frame) {
  if (frame.message_number == message_seen_) return;
  message_seen_ = frame.message_number;
  if (!frame.message.empty()) tell(frame.message, frame.message_is_error);
}

void Panels::message(const Frame& frame, float width, float height) {
  if (notes_.empty() || ImGui::GetTime() >= notes_.back().until) return;
  const Layout l = layout(width, height);
  const float room = width - l.left - 20 * scale, wide = std::min(420 * scale, room);
  if (wide < 60 * scale) return;
  const float top = l.left > 0 ? meter_end_ + 6 * scale : (frame.other ? 52.0f : 10.0f) * scale;
  ImGui::SetNextWindowPos({width - 10 * scale, top}, 0, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.9f);
  ImGui::Begin("message", nullptr, overlay | ImGuiWindowFlags_NoInputs);
  ImGui::PushTextWrapPos(wide - 2 * ImGui::GetStyle().WindowPadding.x);
  text_in(notes_.back().is_error, notes_.back().text);
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void Panels::meters(const Frame& frame, const DrawingFacts& facts, float width, float height) {
  const Meters& m = frame.meters;
  const float room = width - layout(width, height).left - 20 * scale;
  std::string line = frame.settings.paused
                         ? fmt::format("paused at {:.2f} s", frame.time)
                         : fmt::format("{:.0f} % of real time", 100 * m.rate * frame.settings.speed);
  if (facts.frames_a_second > 0 && !frame.settings.paused)
    line += fmt::format(", {:.0f} pictures/s", facts.frames_a_second);
  if (frame.can_resize && (room > 420 * scale || frame.size != 1)) line += ", " + size_names().at(frame.size);
  // A window that takes the size of what is in it does so a picture later: a longer line would be
  // cut.
  const float size = ImGui::GetFontSize(), side = 8 * scale, above = 6 * scale;
  const float wide = std::min(room - 2 * side, 1.3f * size + ImGui::CalcTextSize(line.c_str()).x);
  ImGui::SetNextWindowPos({width - 10 * scale, 10 * scale}, 0, {1, 0});
  ImGui::SetNextWindowSize({wide + 2 * side, size + 2 * above});
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {side, above});
  ImGui::Begin("meter", nullptr, (overlay & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoResize);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::InvisibleButton("fold", {wide, size})) meter_is_open_ = !meter_is_open_;
  note_place("meter");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(meter_is_open_ ? "less" : "more: steps, drawing, messages");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  ImGui::RenderArrow(&list, {at.x, at.y + 0.1f * size}, ink, meter_is_open_ ? ImGuiDir_Down : ImGuiDir_Right, 0.8f);
  list.AddText({at.x + 1.3f * size, at.y}, ink, line.c_str());
  meter_end_ = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  ImGui::End();
  ImGui::PopStyleVar();
  if (meter_is_open_) meter_details(frame, facts, std::min(340 * scale, room));
}

void Panels::meter_details(const Frame& frame, const DrawingFacts& facts, float wide) {
  const Meters& m = frame.meters;
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - 10 * scale, meter_end_ + 4 * scale}, 0, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::Begin("details", nullptr, overlay | ImGuiWindowFlags_NoInputs);
  const float inside = wide - 2 * ImGui::GetStyle().WindowPadding.x;
  ImGui::Dummy({inside, 0});  // as wide whatever it says
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + inside);
  ImGui::Text("%s, t = %.3f s", frame.story.c_str(), frame.time);
  ImGui::Text("%zu particles, %.3g mm apart (%s)", frame.particles, 1e3 * frame.spacing,
              size_names().at(frame.size).c_str());
  ImGui::Text("%d steps a picture, of %.2f ms of work each", m.substeps, m.step_ms);
  ImGui::Text("a step is %.3g ms of the world's time (limit: %s); asked for: %.3g ms", 1e3 * m.taken_dt,
              m.limiter.empty() ? "none yet" : m.limiter.c_str(), 1e3 * m.asked_dt);
  if (!m.remedy.empty()) ImGui::TextDisabled("what makes steps longer: %s", m.remedy.c_str());
  if (facts.frames_a_second > 0)
    ImGui::Text("a picture takes %.0f ms to draw, as %s", facts.draw_ms, std::string(facts.look).c_str());
  ImGui::TextDisabled("%d threads, %s", facts.threads, facts.isa.c_str());
  if (!notes_.empty()) {
    ImGui::Separator();
    for (const Note& note : notes_) text_in(note.is_error, note.text);
  }
  ImGui::PopTextWrapPos();
  meter_end_ = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
  ImGui::End();
}

bool Panels::close_menus() {
  if (ImGui::GetCurrentContext()->OpenPopupStack.Size == 0) return false;
  ImGui::ClosePopupToLevel(0, true);
  return true;
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

void Panels::scale_bar(const Frame& frame, const Cursor& pointer, float width, float height) {
  if (!frame.settings.scale_bar) return;
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
  const bool dark = frame.settings.dark;
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
  std::string_view text, verb;
};
std::vector<Hint> hints_of_tools() {
  std::vector<Hint> all;
  for (const ToolInfo& tool : tool_infos())
    if (!tool.hint.empty()) all.push_back({tool.hint, tool.verbs.front().name});
  return all;
}
const std::vector<Hint>& all_hints() {
  static const std::vector<Hint> all = hints_of_tools();
  return all;
}
/// s: how long one fades, and when those go that nobody follows.
constexpr double fading = 1.5, longest_hint = 60;
/// Pixels of the picture's width, below which hints come one at a time.
constexpr float one_at_a_time = 700;
/// Of those in which hints and meters, or messages, lie beside each other.
constexpr float beside_the_meters = 860;

}  // namespace

void Panels::note_use(std::string_view verb) {
  for (const Hint& hint : all_hints())
    if (hint.verb == verb) hint_used_.try_emplace(hint.text, ImGui::GetTime());
}

double Panels::moves_for() const {
  const double now = ImGui::GetTime();
  double until = now;
  if (!notes_.empty()) until = std::max(until, notes_.back().until);
  for (const Hint& hint : all_hints())
    if (const double fades = fades_at(hint.text); now >= fades) until = std::max(until, fades + fading);
  return until - now;
}

double Panels::fades_at(std::string_view hint) const {
  const auto used = hint_used_.find(hint);
  return used == hint_used_.end() ? longest_hint : std::min(used->second, longest_hint);
}

void Panels::hints(float width, float height, float top) {
  const double now = ImGui::GetTime();
  std::vector<float> alpha;
  for (const Hint& hint : all_hints())
    alpha.push_back(static_cast<float>(std::clamp((fades_at(hint.text) + fading - now) / fading, 0.0, 1.0)));
  const float most = *std::max_element(alpha.begin(), alpha.end());
  if (most <= 0) return;
  const Layout l = layout(width, height);
  const float room = width - l.left - 20 * scale;
  // Before the sky, beside the meters, where there is room; else above the scale bar.
  if (room >= beside_the_meters * scale)
    ImGui::SetNextWindowPos({l.left + 10 * scale, top});
  else
    ImGui::SetNextWindowPos({l.left + (width - l.left) / 2, height - l.bottom - 44 * scale}, 0, {0.5f, 1});
  ImGui::SetNextWindowBgAlpha(0.8f * most);
  ImGui::Begin("hints", nullptr, overlay | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PushTextWrapPos(room - ImGui::GetStyle().WindowPadding.x);
  bool has_one = false;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    if (alpha[i] <= 0) continue;
    // Where there is little room, one after the other.
    if (std::exchange(has_one, true) && room < one_at_a_time * scale) break;
    ImVec4 color = ImGui::GetStyleColorVec4(ImGuiCol_Text);
    color.w *= alpha[i];
    ImGui::TextColored(color, "%s", std::string(all_hints()[i].text).c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void Panels::help_page() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, 0, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {window.x - 10, window.y - 10});
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
