// The parameters of each material, and what they come to.
#include <imgui.h>

#include "dreampm/play/model/number_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class MaterialsPanel final : public Panel {
 public:
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    const Frame& frame = view.frame;
    // In the order of the scene; those that are there begin open.
    for (std::size_t m = 0; m < frame.matter.size(); ++m) {
      const MatterFrame& matter = frame.matter[m];
      if (!host.heading(matter.name, !matter.position.empty())) continue;
      host.controls.draw(frame, matter.name, host);
      if (m >= frame.facts.size()) continue;
      ImGui::PushTextWrapPos(0);
      ImGui::TextDisabled("%s", unit_text(frame.facts[m]).c_str());
      ImGui::PopTextWrapPos();
    }
  }
};

}  // namespace

std::unique_ptr<Panel> make_materials_panel() { return std::make_unique<MaterialsPanel>(); }

}  // namespace dreampm::play
