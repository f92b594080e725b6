// What the window shows of a comparison: its buttons, and the names of the sides over the picture.
#include <fmt/format.h>
#include <imgui.h>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panels.h"

namespace dreampm::play {

void Panels::compare_buttons(const Frame& frame) {
  controls_of(frame, "Compare");
  const Action on = compare_with(static_cast<std::size_t>(asked(frame, "compare_with", static_cast<double>(frame.settings.compare_with))));
  if (ImGui::Button("Compare##start")) post_(on);
  note_place(on.text());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the same twice, under the same hands; key K");
  if (!frame.other) return;
  for (const char* side : {"A", "B"}) {
    ImGui::SameLine();
    const bool is_chosen = side[0] == frame.side;
    if (is_chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::Button(fmt::format("{}##side", side).c_str(), {30 * scale, 0})) post("compare", {"side", side});
    note_place(fmt::format("compare side {}", side));
    if (is_chosen) ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("whose sliders the panel shows; key X for the other");
  }
  ImGui::SameLine();
  if (ImGui::Button("Close")) post("compare", {"off"});
  note_place("compare off");
}

void Panels::compare_labels(const Frame& frame, float width, float height) {
  const Layout l = layout(width, height);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float half = (width - l.left) / 2, bottom = height - l.bottom;
  const bool dark = frame.settings.dark;
  list.AddLine({l.left + half, 0}, {l.left + half, bottom}, color_of(dark ? Vec3f{1, 1, 1} : Vec3f{0, 0, 0}, 0.4f),
               2 * scale);
  for (const Frame* side : {&frame.side_a(), &frame.side_b()}) {
    const std::string text = fmt::format("{}  {}", side->side, side->side_name);
    const float left = l.left + (side->side == 'B' ? half : 0) + 12 * scale,
                top = (is_narrow(frame, width, height) && layout(width, height).left > 0 ? 46.0f : 12.0f) * scale,
                size = 20 * scale;
    const ImVec2 extent = ImGui::GetFont()->CalcTextSizeA(size, 1e9f, 0, text.c_str());
    const bool is_chosen = side == &frame;
    list.AddRectFilled({left, top}, {left + extent.x + 20 * scale, top + extent.y + 10 * scale},
                       ImGui::GetColorU32(is_chosen ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg), 6 * scale);
    list.AddText(ImGui::GetFont(), size, {left + 10 * scale, top + 5 * scale}, ImGui::GetColorU32(ImGuiCol_Text),
                 text.c_str());
  }
}

}  // namespace dreampm::play
