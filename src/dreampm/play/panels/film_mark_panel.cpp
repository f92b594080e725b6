// A red dot and how long the film is that is being made of the picture.
#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <string>

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class FilmMarkPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    const float top = (frame.other ? 52.0f : 12.0f) * scale;
    if (!facts.film_seconds) return;
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const float line = ImGui::GetFontSize();
    const ImVec2 at{layout.left + 14 * scale, top};
    std::string text =
        fmt::format("{}:{:04.1f}", static_cast<int>(*facts.film_seconds) / 60, std::fmod(*facts.film_seconds, 60));
    if (facts.film_waits) text += fmt::format(", slower: {:.1f} s wait for the encoder", facts.film_behind);
    list.AddRectFilled({at.x - 6 * scale, at.y - 4 * scale},
                       {at.x + 1.4f * line + ImGui::CalcTextSize(text.c_str()).x + 6 * scale, at.y + line + 4 * scale},
                       ImGui::GetColorU32(ImGuiCol_PopupBg, 0.8f), 5 * scale);
    list.AddCircleFilled({at.x + line / 2, at.y + line / 2}, 0.4f * line, color_of(film_red), 24);
    list.AddText({at.x + 1.4f * line, at.y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  }
};

}  // namespace

std::unique_ptr<Panel> make_film_mark_panel() { return std::make_unique<FilmMarkPanel>(); }

}  // namespace dreampm::play
