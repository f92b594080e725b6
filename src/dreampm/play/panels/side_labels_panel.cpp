// The names of the sides of a comparison, over the picture.
#include <fmt/format.h>
#include <imgui.h>

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class SideLabelsPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    if (!frame.other) return;
    const float scale = host.scale;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float half = view.picture_width() / 2, bottom = height - layout.bottom;
    list.AddLine({layout.left + half, 0}, {layout.left + half, bottom},
                 color_of(frame.settings.dark ? Vec3f{1, 1, 1} : Vec3f{0, 0, 0}, 0.4f), 2 * scale);
    // Of a picture that is too small for all lines of the meters, below those.
    const bool is_narrow = view.picture_width() < 960 * scale;
    for (const Frame* side : {&frame.side_a(), &frame.side_b()}) {
      const std::string text = fmt::format("{}  {}", side->side, side->side_name);
      const float left = layout.left + (side->side == 'B' ? half : 0) + 12 * scale,
                  top = (is_narrow && layout.has_panels() ? 46.0f : 12.0f) * scale, size = 20 * scale;
      const ImVec2 extent = ImGui::GetFont()->CalcTextSizeA(size, 1e9f, 0, text.c_str());
      const bool is_chosen = side == &frame;
      list.AddRectFilled({left, top}, {left + extent.x + 20 * scale, top + extent.y + 10 * scale},
                         ImGui::GetColorU32(is_chosen ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg), 6 * scale);
      list.AddText(ImGui::GetFont(), size, {left + 10 * scale, top + 5 * scale}, ImGui::GetColorU32(ImGuiCol_Text),
                   text.c_str());
    }
  }
};

}  // namespace

std::unique_ptr<Panel> make_side_labels_panel() { return std::make_unique<SideLabelsPanel>(); }

}  // namespace dreampm::play
