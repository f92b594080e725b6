// The scale of the colors of matter. It belongs to the picture.
#include <imgui.h>

#include "dreampm/gl/color_scale.h"
#include "dreampm/play/panels/panels.h"

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class LegendPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    if (frame.value_label.empty()) return;
    ImGui::SetNextWindowPos({width - 10 * scale, height - layout.bottom - 10 * scale}, 0, {1, 1});
    ImGui::SetNextWindowBgAlpha(0.72f);
    ImGui::Begin(Panels::legend_window, nullptr,
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
};

}  // namespace

std::unique_ptr<Panel> make_legend_panel() { return std::make_unique<LegendPanel>(); }

}  // namespace dreampm::play
