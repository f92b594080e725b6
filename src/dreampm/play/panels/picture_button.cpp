#include "dreampm/play/panels/picture_button.h"

#include <algorithm>
#include <cstdint>

namespace dreampm::play {
namespace {

/// Of what is off.
constexpr float pale = 0.35f;

}  // namespace

bool picture_button(const Pictures* pictures, const PictureButton& b, float scale) {
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

}  // namespace dreampm::play
