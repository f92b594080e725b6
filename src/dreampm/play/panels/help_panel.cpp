// The page of keys.
#include <imgui.h>

#include "dreampm/play/panels/key_help.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class HelpPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView&, PanelHost& host) override {
    if (!host.help) return;
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, 0, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {window.x - 10, window.y - 10});
    ImGui::Begin("Keys", &host.help,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::BeginTable("keys", 2)) {
      for (const KeyHelp& row : key_help()) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.keys.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.what.c_str());
      }
      ImGui::EndTable();
    }
    ImGui::End();
  }
};

}  // namespace

std::unique_ptr<Panel> make_help_panel() { return std::make_unique<HelpPanel>(); }

}  // namespace dreampm::play
