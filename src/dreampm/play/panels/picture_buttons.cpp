// Buttons with a picture: kinds of matter, and stories.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <map>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/panels/panels.h"
#include "dreampm/play/panels/pictures.h"
#include "dreampm/play/report/report_config.h"
#include "dreampm/play/report/report_looks.h"

namespace dreampm::play {
namespace {

struct Button {
  std::string picture, title, key;
  ImVec2 size;
  float letters;  ///< height, of the font's
  bool chosen;
  bool off = false;
};

/// Of what is off.
constexpr float pale = 0.35f;

/// Whether it was pressed.
bool picture_button(const Pictures* pictures, const Button& b, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos(), end{at.x + b.size.x, at.y + b.size.y};
  const bool pressed = ImGui::InvisibleButton(b.picture.c_str(), b.size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImGuiCol ground = b.chosen                 ? ImGuiCol_ButtonActive
                          : ImGui::IsItemHovered() ? ImGuiCol_ButtonHovered
                                                   : ImGuiCol_FrameBg;
  list.AddRectFilled(at, end, ImGui::GetColorU32(ground), 6 * scale);
  const float size = ImGui::GetFontSize() * b.letters, edge = 3 * scale;
  const ImVec2 text = ImGui::GetFont()->CalcTextSizeA(size, 1e9f, 0, b.title.c_str());
  const float bottom = end.y - text.y - 2.5f * scale;
  const Pictures::Picture* const p = pictures ? pictures->find(b.picture) : nullptr;
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text, b.off ? pale : 1);
  if (p) {
    list.AddText(ImGui::GetFont(), size, {at.x + (b.size.x - text.x) / 2, bottom}, ink, b.title.c_str());
  } else {
    list.PushClipRect(at, end, true);
    list.AddText(ImGui::GetFont(), size, {at.x + edge, at.y + edge}, ink, b.title.c_str(), nullptr,
                 b.size.x - 2 * edge);
    list.PopClipRect();
  }
  if (!p && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", b.title.c_str());
  if (p) {
    // As much of its middle as has the button's proportions.
    const ImVec2 from{at.x + edge, at.y + edge}, to{end.x - edge, bottom - scale};
    const float wanted = (to.x - from.x) / std::max(to.y - from.y, 1.0f),
                has = static_cast<float>(p->width) / static_cast<float>(p->height);
    const float x = 0.5f * std::max(0.0f, 1 - wanted / has), y = 0.5f * std::max(0.0f, 1 - has / wanted);
    list.AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(p->texture)), from, to, {x, y},
                         {1 - x, 1 - y}, b.off ? IM_COL32(255, 255, 255, 255 * pale) : IM_COL32_WHITE, 4 * scale);
  }
  if (!b.key.empty())
    list.AddText(ImGui::GetFont(), size * 0.95f, {at.x + 6 * scale, at.y + 4 * scale}, IM_COL32(20, 30, 45, 190),
                 b.key.c_str());
  return pressed;
}

bool is_refused(const Frame& frame, std::size_t kind) {
  return kind < frame.matter_refusals.size() && !frame.matter_refusals[kind].empty();
}

}  // namespace

void Panels::choose_matter(const Frame& frame, std::size_t kind) {
  if (!is_refused(frame, kind)) return set("matter", static_cast<double>(kind));
  tell(fmt::format("{}: {}{}", matters()[kind].title, frame.matter_refusals[kind],
                   frame.no_other.empty() ? fmt::format("; the other solver can (key {})", solver_key) : ""),
       true);
}

void Panels::matter_buttons(const Frame& frame) {
  ImGui::TextUnformatted("Matter");
  const double chosen = asked(frame, "matter", frame.settings.matter);
  const float side = (ImGui::GetContentRegionAvail().x - 4 * ImGui::GetStyle().ItemSpacing.x) / 5;
  for (std::size_t kind = 0; kind < matters().size(); ++kind) {
    const Matter& m = matters()[kind];
    if (kind % 5 != 0) ImGui::SameLine();
    if (picture_button(pictures,
                       {fmt::format("matter-{}", m.name),
                        std::string(m.title),
                        std::string(1, m.key),
                        {side, 1.02f * side},
                        0.72f,
                        static_cast<std::size_t>(chosen) == kind,
                        is_refused(frame, kind)},
                       scale))
      choose_matter(frame, kind);
    note_place(fmt::format("set matter {}", kind));
    if (is_refused(frame, kind) && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", frame.matter_refusals[kind].c_str());
  }
}

void Panels::look_buttons(const Frame& frame) {
  // Where a config's preset has no such material there is nothing to set.
  std::map<std::string, double, std::less<>> now;
  const std::string prefix = fmt::format("material.{}.", report_material_name(diy_material));
  for (std::size_t i = 0; i < frame.controls->size(); ++i)
    if (const ControlInfo& c = (*frame.controls)[i]; c.id.starts_with(prefix))
      now[c.id.substr(prefix.size())] = asked(frame, c.id, frame.values[i]);
  if (!now.contains("v")) return;
  const std::span<const ReportLook> looks = report_looks();
  const auto count = static_cast<float>(looks.size());
  const float side = (ImGui::GetContentRegionAvail().x - (count - 1) * ImGui::GetStyle().ItemSpacing.x) / count;
  for (const ReportLook& look : looks) {
    if (&look != &looks.front()) ImGui::SameLine();
    // What is elastic is so whatever V and the bounds are.
    const auto values = look.values();
    const bool chosen = std::all_of(values.begin(), values.end(), [&](const ReportLook::Value& v) {
      return v.key == "elastic" ? now[std::string(v.key)] == v.value
                                : look.elastic || now[std::string(v.key)] == v.value;
    });
    if (picture_button(
            pictures,
            {fmt::format("look-{}", look.name), std::string(look.title), "", {side, 0.95f * side}, 0.72f, chosen},
            scale))
      post("look", {std::string(look.name)}), edits_ = true;
    note_place(fmt::format("look {}", look.name));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(look.help).c_str());
  }
}

void Panels::story_buttons(const Frame& frame) {
  constexpr std::size_t presets = 2;
  const std::size_t own = frame.preset_file == "report" ? 0 : frame.presets.size();
  const auto count = static_cast<float>(stories().size() + presets + own), gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = std::clamp((ImGui::GetContentRegionAvail().x + gap) / count - gap, 66 * scale, 104 * scale);
  const ImVec2 size{width, ImGui::GetContentRegionAvail().y};
  const auto button = [&](const std::string& picture, const std::string& title, bool is_open,
                          const std::vector<std::string>& words) {
    if (picture_button(pictures, {picture, title, "", size, 0.64f, is_open}, scale))
      post("open", words), new_stage_ = true;
    note_place(fmt::format("open {}", words.size() > 1 ? words[0] + " " + words[1] : words[0]));
    ImGui::SameLine();
  };
  for (const Story& s : stories())
    button(std::string(s.name), std::string(s.title), frame.story == s.name, {std::string(s.name)});
  // A config that was opened has its own.
  if (frame.preset_file != "report")
    for (std::size_t preset = 0; preset < frame.presets.size(); ++preset)
      button(fmt::format("preset-{}", preset + 1), frame.presets[preset], frame.preset == preset,
             {frame.preset_file, std::to_string(preset + 1)});
  for (std::size_t preset = 1; preset <= presets; ++preset)
    button(fmt::format("report-{}", preset), fmt::format("Report {}", preset),
           frame.preset_file == "report" && frame.preset + 1 == preset, {"report", std::to_string(preset)});
}

}  // namespace dreampm::play
