// What the report's program has: looks of its material, and its settings.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "dreampm/play/panels/panel_host.h"
#include "dreampm/play/panels/picture_button.h"
#include "dreampm/play/report/report_config.h"
#include "dreampm/play/report/report_looks.h"

namespace dreampm::play {
namespace {

class ReportPanel final : public Panel {
 public:
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    const std::vector<ControlInfo>& controls = *view.frame.controls;
    const bool is_there =
        std::any_of(controls.begin(), controls.end(), [](const ControlInfo& c) { return c.panel == "Report"; });
    if (!is_there || !host.heading("Report")) return;
    buttons(view.frame, host);
    host.controls.draw(view.frame, "Report", host);
  }

 private:
  static void buttons(const Frame& frame, PanelHost& host) {
    // Where a config's preset has no such material there is nothing to set.
    std::map<std::string, double, std::less<>> now;
    const std::string prefix = fmt::format("material.{}.", report_material_name(diy_material));
    for (std::size_t i = 0; i < frame.controls->size(); ++i)
      if (const ControlInfo& c = (*frame.controls)[i]; c.id.starts_with(prefix))
        now[c.id.substr(prefix.size())] = host.asked(frame, c.id, frame.values[i]);
    if (!now.contains("v")) return;
    const std::span<const ReportLook> all = report_looks();
    const auto count = static_cast<float>(all.size());
    const float side = (ImGui::GetContentRegionAvail().x - (count - 1) * ImGui::GetStyle().ItemSpacing.x) / count;
    for (const ReportLook& look : all) {
      if (&look != &all.front()) ImGui::SameLine();
      // What is elastic is so whatever V and the bounds are.
      const auto values = look.values();
      const bool chosen = std::all_of(values.begin(), values.end(), [&](const ReportLook::Value& v) {
        return v.key == "elastic" ? now[std::string(v.key)] == v.value
                                  : look.elastic || now[std::string(v.key)] == v.value;
      });
      if (picture_button(
              host.pictures,
              {fmt::format("look-{}", look.name), std::string(look.title), "", {side, 0.95f * side}, 0.72f, chosen},
              host.scale))
        host.post("look", {std::string(look.name)}), host.edits = true;
      host.note_place(fmt::format("look {}", look.name));
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(look.help).c_str());
    }
  }
};

}  // namespace

std::unique_ptr<Panel> make_report_panel() { return std::make_unique<ReportPanel>(); }

}  // namespace dreampm::play
