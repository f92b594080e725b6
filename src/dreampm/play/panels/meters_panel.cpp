// How fast the world goes, and what that comes from; a click unfolds the rest.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>

#include "dreampm/play/model/play_scene.h"

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class MetersPanel final : public Panel {
 public:
  Where where() const override { return Where::beside; }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    const Meters& m = frame.meters;
    const float room = view.picture_width() - 20 * scale;
    std::string line = frame.settings.paused
                           ? fmt::format("paused at {:.2f} s", frame.time)
                           : fmt::format("{:.0f} % of real time", 100 * m.rate * frame.settings.speed);
    if (facts.frames_a_second > 0 && !frame.settings.paused)
      line += fmt::format(", {:.0f} pictures/s", facts.frames_a_second);
    if (frame.can_resize && (room > 420 * scale || frame.size != 1)) line += ", " + size_names().at(frame.size);
    // A window that takes the size of what is in it does so a picture later: a longer line would be
    // cut.
    const float size = ImGui::GetFontSize(), side = 8 * scale, above = 6 * scale;
    const float wide = std::min(room - 2 * side, 1.3f * size + ImGui::CalcTextSize(line.c_str()).x);
    ImGui::SetNextWindowPos({width - 10 * scale, 10 * scale}, 0, {1, 0});
    ImGui::SetNextWindowSize({wide + 2 * side, size + 2 * above});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {side, above});
    ImGui::Begin("meter", nullptr, (overlay_flags & ~ImGuiWindowFlags_AlwaysAutoResize) | ImGuiWindowFlags_NoResize);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("fold", {wide, size})) is_open_ = !is_open_;
    host.note_place("meter");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip(is_open_ ? "less" : "more: steps, drawing, messages");
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
    ImGui::RenderArrow(&list, {at.x, at.y + 0.1f * size}, ink, is_open_ ? ImGuiDir_Down : ImGuiDir_Right, 0.8f);
    list.AddText({at.x + 1.3f * size, at.y}, ink, line.c_str());
    host.below_meters = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
    ImGui::End();
    ImGui::PopStyleVar();
    if (is_open_) details(view, host, std::min(340 * scale, room));
  }

 private:
  void details(const PanelView& view, PanelHost& host, float wide) const {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    const Meters& m = frame.meters;
    ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - 10 * scale, host.below_meters + 4 * scale}, 0, {1, 0});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin("details", nullptr, overlay_flags | ImGuiWindowFlags_NoInputs);
    const float inside = wide - 2 * ImGui::GetStyle().WindowPadding.x;
    ImGui::Dummy({inside, 0});  // as wide whatever it says
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + inside);
    ImGui::Text("%s, t = %.3f s", frame.story.c_str(), frame.time);
    ImGui::Text("%zu particles, %.3g mm apart (%s)", frame.particles, 1e3 * frame.spacing,
                size_names().at(frame.size).c_str());
    ImGui::Text("%d steps a picture, of %.2f ms of work each", m.substeps, m.step_ms);
    ImGui::Text("a step is %.3g ms of the world's time (limit: %s); asked for: %.3g ms", 1e3 * m.taken_dt,
                m.limiter.empty() ? "none yet" : m.limiter.c_str(), 1e3 * m.asked_dt);
    if (!m.remedy.empty()) ImGui::TextDisabled("what makes steps longer: %s", m.remedy.c_str());
    if (facts.frames_a_second > 0)
      ImGui::Text("a picture takes %.0f ms to draw, as %s", facts.draw_ms, std::string(facts.look).c_str());
    ImGui::TextDisabled("%d threads, %s", facts.threads, facts.backend.c_str());
    if (!host.notes.empty()) {
      ImGui::Separator();
      for (const Note& note : host.notes) draw_note(note);
    }
    ImGui::PopTextWrapPos();
    host.below_meters = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
    ImGui::End();
  }

  bool is_open_ = false;
};

}  // namespace

std::unique_ptr<Panel> make_meters_panel() { return std::make_unique<MetersPanel>(); }

}  // namespace dreampm::play
