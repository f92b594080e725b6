// The latest message, for some seconds.
#include <imgui.h>

#include <algorithm>

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class MessagesPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    if (host.notes.empty() || ImGui::GetTime() >= host.notes.back().until) return;
    const float room = view.picture_width() - 20 * scale, wide = std::min(420 * scale, room);
    if (wide < 60 * scale) return;
    const float top = layout.left > 0 ? host.below_meters + 6 * scale : (frame.other ? 52.0f : 10.0f) * scale;
    ImGui::SetNextWindowPos({width - 10 * scale, top}, 0, {1, 0});
    ImGui::SetNextWindowBgAlpha(0.9f);
    ImGui::Begin("message", nullptr, overlay_flags | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(wide - 2 * ImGui::GetStyle().WindowPadding.x);
    draw_note(host.notes.back());
    ImGui::PopTextWrapPos();
    ImGui::End();
  }
};

}  // namespace

std::unique_ptr<Panel> make_messages_panel() { return std::make_unique<MessagesPanel>(); }

}  // namespace dreampm::play
