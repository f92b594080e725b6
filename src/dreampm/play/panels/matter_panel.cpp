// Kinds of matter, a button each.
#include <fmt/format.h>

#include "dreampm/play/model/matter.h"
#include "dreampm/play/panels/panel_host.h"
#include "dreampm/play/panels/picture_button.h"

namespace dreampm::play {
namespace {

class MatterPanel final : public Panel {
 public:
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    const Frame& frame = view.frame;
    ImGui::TextUnformatted("Matter");
    const double chosen = host.asked(frame, "matter", static_cast<double>(frame.settings.matter));
    const float side = (ImGui::GetContentRegionAvail().x - 4 * ImGui::GetStyle().ItemSpacing.x) / 5;
    for (std::size_t kind = 0; kind < matters().size(); ++kind) {
      const Matter& m = matters()[kind];
      const std::string refusal = kind < frame.matter_refusals.size() ? frame.matter_refusals[kind] : "";
      if (kind % 5 != 0) ImGui::SameLine();
      if (picture_button(host.pictures,
                         {fmt::format("matter-{}", m.name),
                          std::string(m.title),
                          std::string(1, m.key),
                          {side, 1.02f * side},
                          0.72f,
                          static_cast<std::size_t>(chosen) == kind,
                          !refusal.empty()},
                         host.scale))
        host.choose_matter(frame, kind);
      host.note_place(fmt::format("set matter {}", kind));
      if (!refusal.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", refusal.c_str());
    }
    ImGui::Spacing();
  }
};

}  // namespace

std::unique_ptr<Panel> make_matter_panel() { return std::make_unique<MatterPanel>(); }

}  // namespace dreampm::play
