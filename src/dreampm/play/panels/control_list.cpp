#include "dreampm/play/panels/control_list.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

/// Pixels that a press on a slider may move by and is no drag yet.
constexpr float still = 3;
/// Pixels between an end of a slider and a knob that stands there, as Dear ImGui has it.
constexpr float slider_padding = 2;

/// Decimals that tell a number above 0 from 0.
int decimals_of(double value) {
  return value > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(value))), 3, 12) : 3;
}

/// What stands left and right in a row of the panel; letters of a name that is too long are
/// smaller.
void row(const std::string& left, const std::string& right) {
  const float wide = ImGui::GetContentRegionAvail().x, size = ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float taken = right.empty() ? 0 : ImGui::CalcTextSize(right.c_str()).x;
  const float own = ImGui::CalcTextSize(left.c_str()).x,
              room = wide - taken - (right.empty() ? 0 : ImGui::GetStyle().ItemSpacing.x);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  list.AddText(ImGui::GetFont(), own > room ? size * room / own : size, at, ink, left.c_str());
  if (!right.empty()) list.AddText({at.x + wide - taken, at.y}, ink, right.c_str());
  ImGui::Dummy({wide, size});
}

}  // namespace

void ControlList::draw(const Frame& frame, const std::string& panel, PanelHost& host) {
  std::size_t more = 0, all = 0;
  for (const ControlInfo& c : *frame.controls)
    if (c.panel == panel && c.color.empty()) ++all, more += c.advanced ? 1 : 0;
  const bool shows_all = all_of_.contains(panel);
  for (std::size_t i = 0; i < frame.controls->size(); ++i) {
    const ControlInfo& c = (*frame.controls)[i];
    // Tools have buttons.
    if (c.panel != panel || c.id == "tool") continue;
    if (!c.color.empty()) {
      color(frame, i, host);
      i += 2;
      continue;
    }
    if (c.advanced && !shows_all) continue;
    const auto other = std::find_if(frame.controls->begin(), frame.controls->end(),
                                    [&](const ControlInfo& o) { return o.id == c.needs; });
    const bool is_idle =
        other != frame.controls->end() &&
        (host.asked(frame, other->id, frame.values[static_cast<std::size_t>(other - frame.controls->begin())]) == 0) !=
            c.needs_off;
    if (is_idle) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.45f * ImGui::GetStyle().Alpha);
    control(c, host.asked(frame, c.id, frame.values[i]), frame.live[i], host);
    if (is_idle) ImGui::PopStyleVar();
  }
  if (more == 0) return;
  const std::string text = shows_all ? "fewer" : fmt::format("all {}...", all);
  if (ImGui::SmallButton(fmt::format("{}##{}", text, panel).c_str())) {
    if (shows_all)
      all_of_.erase(panel);
    else
      all_of_.insert(panel);
  }
  host.note_place("all " + panel);
}

void ControlList::color(const Frame& frame, std::size_t first, PanelHost& host) {
  const ControlInfo& c = (*frame.controls)[first];
  std::array<float, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k)
    rgb[k] = static_cast<float>(host.asked(frame, (*frame.controls)[first + k].id, frame.values[first + k]));
  // Colors of several materials bear the same label.
  ImGui::PushID(c.color.c_str());
  const float high = ImGui::GetFrameHeight();
  // As wide as no switch is.
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, host.scale);
  if (ImGui::ColorButton("##color", {rgb[0], rgb[1], rgb[2], 1}, ImGuiColorEditFlags_NoTooltip, {3 * high, high}))
    ImGui::OpenPopup("picker");
  ImGui::PopStyleVar();
  host.note_place(c.color);
  const ImVec2 below{ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y + ImGui::GetStyle().ItemSpacing.y};
  ImGui::SameLine();
  ImGui::TextUnformatted(c.label.c_str());
  ImGui::SetNextWindowPos(below, ImGuiCond_Appearing);
  if (ImGui::BeginPopup("picker")) {
    ImGui::SetNextItemWidth(12 * ImGui::GetFontSize());
    if (ImGui::ColorPicker3("##picker", rgb.data(), ImGuiColorEditFlags_NoSidePreview))
      for (std::size_t k = 0; k < 3; ++k) host.set((*frame.controls)[first + k].id, static_cast<double>(rgb[k]));
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

void ControlList::mark_live(const ControlInfo& c, const LiveRange& live, float wide) {
  const bool log = c.decades && c.min > 0;
  const auto at = [&](double x) {
    return static_cast<float>(log ? std::log(x / c.min) / std::log(c.max / c.min) : (x - c.min) / (c.max - c.min));
  };
  const ImVec2 from = ImGui::GetItemRectMin();
  const float low = from.y, high = ImGui::GetItemRectMax().y, rounding = ImGui::GetStyle().FrameRounding;
  constexpr ImU32 red = IM_COL32(220, 50, 40, 110);
  const auto mark = [&](float left, float right) {
    if (right > left) ImGui::GetWindowDrawList()->AddRectFilled({left, low}, {right, high}, red, rounding);
  };
  // A knob that stands at a limit is beside the red.
  const float knob = ImGui::GetStyle().GrabMinSize, room = wide - 2 * slider_padding - knob;
  if (live.min > c.min) mark(from.x, from.x + slider_padding + at(live.min) * room);
  if (live.max < c.max) mark(from.x + slider_padding + at(live.max) * room + knob, from.x + wide);
}

void ControlList::slider(const ControlInfo& c, double value, const LiveRange& live, PanelHost& host) {
  // A click may be the first of two that reset: what it sets waits until that is known.
  const bool held = held_.id == c.id;
  const double now_shown = held && !held_.moved ? held_.value : value;
  row(c.label, with_unit(now_shown, c.unit));
  const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() - 0.7f * spacing.y);
  double edited = now_shown;
  const ImGuiSliderFlags flags =
      (c.decades ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, 0});
  const float wide = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(wide);
  // The number stands above the knob; while one is typed it stands here.
  const ImGuiIO& io = ImGui::GetIO();
  const bool typed = ImGui::TempInputIsActive(ImGui::GetID("##slider"));
  if (!typed) ImGui::PushStyleColor(ImGuiCol_Text, {0, 0, 0, 0});
  // Dear ImGui begins a logarithmic host.scale where the decimals of its text end.
  const std::string text = typed || io.KeyCtrl ? value_text(now_shown) : fmt::format("%.{}f", decimals_of(c.min));
  const bool changed =
      ImGui::SliderScalar("##slider", ImGuiDataType_Double, &edited, &c.min, &c.max, text.c_str(), flags);
  if (!typed) ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  mark_live(c, live, wide);
  if (ImGui::IsItemActivated()) live_of_drag_ = live, holds_ = Holds::no;
  if (holds_ != Holds::no && ImGui::IsItemActive()) {
    if (holds_ == Holds::soft)
      ImGui::SetTooltip(
          "further, soft matter would be crushed by what lies on it, or as it falls, and stay so.\n"
          "Shift lets it go on");
    else
      ImGui::SetTooltip("as %s as is live: further, time runs at less than a quarter of its pace.\nShift lets it go on",
                        c.id.ends_with("modulus") ? "stiff" : "far");
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    held_ = {};
    ImGui::ClearActiveID();
    host.set(c.id, c.fallback);
    return;
  }
  if (ImGui::IsItemActivated() && ImGui::IsMouseClicked(0) && !io.KeyCtrl)
    held_ = {c.id, now_shown, ImGui::GetTime(), io.MousePos.x};
  if (changed && edited != now_shown) {
    // From where it stands, wherever that is, it goes on.
    const double wanted = std::clamp(edited, c.min, c.max);
    edited = std::clamp(wanted, std::min(live_of_drag_.min, value), std::max(live_of_drag_.max, value));
    const bool is_soft = wanted > edited ? live_of_drag_.max_is_soft : live_of_drag_.min_is_soft;
    holds_ = edited == wanted || io.KeyShift ? Holds::no : is_soft ? Holds::soft : Holds::slow;
    if (io.KeyShift) edited = wanted;
    if (held_.id == c.id && !held_.moved && std::abs(io.MousePos.x - held_.x) <= still) {
      held_.value = edited, held_.has_value = true;
    } else {
      if (held_.id == c.id) held_.moved = true;
      host.set(c.id, edited);
    }
  }
  if (held_.id != c.id) return;
  const bool is_drag = std::abs(io.MousePos.x - held_.x) > still,
             is_late = ImGui::GetTime() - held_.began > static_cast<double>(io.MouseDoubleClickTime);
  if (!held_.moved && held_.has_value && (is_drag || is_late)) {
    held_.moved = true;
    host.set(c.id, held_.value);
  }
  if (!ImGui::IsItemActive() && (held_.moved || !held_.has_value)) held_ = {};
}

void ControlList::control(const ControlInfo& c, double value, const LiveRange& live, PanelHost& host) {
  ImGui::PushID(c.id.c_str());
  if (c.is_switch()) {
    bool on = value != 0;
    ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, host.scale);
    if (ImGui::Checkbox(c.label.c_str(), &on)) host.set(c.id, on ? 1 : 0);
    ImGui::PopStyleVar();
  } else if (!c.choices.empty()) {
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.55f);
    const auto at = static_cast<std::size_t>(std::clamp(value, 0.0, static_cast<double>(c.choices.size() - 1)));
    if (ImGui::BeginCombo(c.label.c_str(), c.choices[at].c_str())) {
      for (std::size_t n = 0; n < c.choices.size(); ++n)
        if (ImGui::Selectable(c.choices[n].c_str(), n == at)) host.set(c.id, static_cast<double>(n));
      ImGui::EndCombo();
    }
  } else {
    slider(c, value, live, host);
  }
  host.note_place(c.id);
  // Words about a pale control are not pale.
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1);
  if (ImGui::BeginPopupContextItem("about")) {
    ImGui::Text("%s", c.help.c_str());
    if (c.choices.empty()) ImGui::Text("%s to %s", value_text(c.min).c_str(), with_unit(c.max, c.unit).c_str());
    ImGui::TextDisabled("in scripts: set %s %s", c.id.c_str(), value_text(value).c_str());
    if (ImGui::Selectable("reset")) host.set(c.id, c.fallback);
    ImGui::EndPopup();
  }
  if (ImGui::IsItemHovered() && !c.help.empty() && ImGui::GetCurrentContext()->HoveredIdTimer > 0.6f) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(340 * host.scale);
    ImGui::TextUnformatted(c.help.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  ImGui::PopStyleVar();
  ImGui::PopID();
}

}  // namespace dreampm::play
