// A length, at the depth of the middle of the box.
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "dreampm/play/panels/panels.h"

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class ScaleBarPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    if (!frame.settings.scale_bar) return;
    const gl::Camera camera = cursor.seen_by();
    const Vec3d to_middle = frame.domain.center() - static_cast<Vec3d>(camera.eye);
    const double depth = dot(to_middle, static_cast<Vec3d>(camera.axes().forward));
    if (!(depth > 0)) return;
    const double pixels =
        static_cast<double>(camera.pixels_per_slope(static_cast<int>(height - layout.bottom))) / depth;
    const double wide = static_cast<double>(width - layout.left) / 5;
    if (!(pixels > 0) || !(wide > 0)) return;
    const RoundLength length = round_length(wide / pixels);
    const auto long_ = static_cast<float>(length.meters * pixels);
    const ImVec2 from{layout.left + 16 * scale, height - layout.bottom - 14 * scale}, to{from.x + long_, from.y};
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const bool dark = frame.settings.dark;
    // A line of the other lightness about it: it stands before anything.
    for (const bool about : {true, false}) {
      const ImU32 color = color_of(dark == about ? Vec3f{0.05f, 0.07f, 0.1f} : Vec3f{1, 1, 1}, about ? 0.6f : 1.0f);
      const float thick = (about ? 4.5f : 2.0f) * scale, tick = (about ? 6.0f : 5.0f) * scale;
      list.AddLine(from, to, color, thick);
      for (const float x : {from.x, to.x}) list.AddLine({x, from.y - tick}, {x, from.y + tick}, color, thick);
    }
    const ImVec2 size = ImGui::CalcTextSize(length.text.c_str());
    const ImVec2 at{from.x + 0.5f * (long_ - size.x), from.y - size.y - 6 * scale};
    const auto letters = [&](float dx, float dy, bool about) {
      list.AddText({at.x + dx, at.y + dy},
                   color_of(dark == about ? Vec3f{0.05f, 0.07f, 0.1f} : Vec3f{1, 1, 1}, about ? 0.5f : 1.0f),
                   length.text.c_str());
    };
    for (const float d : {-scale, scale}) letters(d, 0, true), letters(0, d, true);
    letters(0, 0, false);
  }
};

}  // namespace

RoundLength round_length(double most) {
  const double decade = std::pow(10, std::floor(std::log10(most) + 1e-9)), times = most / decade * (1 + 1e-9);
  const double meters = decade * (times >= 5 ? 5 : times >= 2 ? 2 : 1);
  const auto in = [&](double unit, const char* name) { return fmt::format("{:.4g} {}", meters / unit, name); };
  return {meters, meters >= 1 ? in(1, "m") : meters >= 0.01 ? in(0.01, "cm") : in(0.001, "mm")};
}

std::unique_ptr<Panel> make_scale_bar_panel() { return std::make_unique<ScaleBarPanel>(); }

}  // namespace dreampm::play
