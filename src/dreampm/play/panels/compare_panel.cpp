// What begins, steers and ends a comparison.
#include <fmt/format.h>
#include <imgui.h>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class ComparePanel final : public Panel {
 public:
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    if (!host.heading("Compare")) return;
    const Frame& frame = view.frame;
    host.controls.draw(frame, "Compare", host);
    const double kind = host.asked(frame, "compare_with", static_cast<double>(frame.settings.compare_with));
    const Action on = compare_with(static_cast<std::size_t>(kind));
    if (ImGui::Button("Compare##start")) host.post(on);
    host.note_place(on.text());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("the same twice, under the same tools; key K");
    if (!frame.other) return;
    for (const char* side : {"A", "B"}) {
      ImGui::SameLine();
      if (host.choice(fmt::format("{}##side", side), side[0] == frame.side, 30 * host.scale))
        host.post("compare", {"side", side});
      host.note_place(fmt::format("compare side {}", side));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("whose sliders the panel shows; key X for the other");
    }
    ImGui::SameLine();
    if (ImGui::Button("Close")) host.post("compare", {"off"});
    host.note_place("compare off");
  }
};

}  // namespace

std::unique_ptr<Panel> make_compare_panel() { return std::make_unique<ComparePanel>(); }

}  // namespace dreampm::play
