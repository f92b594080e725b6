// Tools, a button each, and those that they have besides.
#include <fmt/format.h>
#include <imgui.h>

#include "dreampm/play/panels/panel_host.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class ToolsPanel final : public Panel {
 public:
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    const Frame& frame = view.frame;
    ImGui::TextUnformatted("Tool");
    const double chosen = host.asked(frame, "tool", static_cast<double>(frame.settings.tool));
    for (std::size_t t = 0; t < tool_buttons().size(); ++t) {
      const ToolInfo& tool = tool_buttons()[t];
      if (t % 4 != 0) ImGui::SameLine();
      const float width = (ImGui::GetWindowContentRegionMax().x - ImGui::GetWindowContentRegionMin().x -
                           3 * ImGui::GetStyle().ItemSpacing.x) /
                          4;
      if (host.choice(fmt::format("{}##tool", tool.name), static_cast<std::size_t>(chosen) == t, width))
        host.set("tool", static_cast<double>(t));
      host.note_place(fmt::format("set tool {}", t));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("key %c", tool.key);
    }
    for (const ToolButton& button : frame.buttons) {
      if (ImGui::Button(fmt::format("{}##of_tool", button.text).c_str())) host.post(button.action);
      host.note_place(button.action.text());
    }
    ImGui::Spacing();
  }
};

}  // namespace

std::unique_ptr<Panel> make_tools_panel() { return std::make_unique<ToolsPanel>(); }

}  // namespace dreampm::play
