// What a beginner does not know, in the first minute.
#include <imgui.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

class HintsPanel final : public Panel {
 public:
  HintsPanel() {
    for (const ToolInfo& tool : tool_infos())
      if (!tool.hint.empty()) hints_.push_back({tool.hint, tool.verbs.front().name});
  }
  Where where() const override { return Where::beside; }
  void note_use(std::string_view verb) override {
    for (Hint& hint : hints_)
      if (hint.verb == verb) hint.fades = std::min(hint.fades, ImGui::GetTime());
  }
  double changes_until() const override {
    double until = 0;
    for (const Hint& hint : hints_)
      if (ImGui::GetTime() >= hint.fades) until = std::max(until, hint.fades + fading);
    return until;
  }
  void draw(const PanelView& view, PanelHost& host) override {
    const auto& [frame, cursor, facts, width, height, layout] = view;
    const float scale = host.scale;
    const float top = (frame.other ? 52.0f : 12.0f) * scale + (facts.film_seconds ? 26 * scale : 0);
    const double now = ImGui::GetTime();
    std::vector<float> alpha;
    for (const Hint& hint : hints_)
      alpha.push_back(static_cast<float>(std::clamp((hint.fades + fading - now) / fading, 0.0, 1.0)));
    const float most = *std::max_element(alpha.begin(), alpha.end());
    if (most <= 0) return;
    const float room = view.picture_width() - 20 * scale;
    // Before the sky, beside the meters, where there is room; else above the scale bar.
    if (room >= beside_the_meters * scale)
      ImGui::SetNextWindowPos({layout.left + 10 * scale, top});
    else
      ImGui::SetNextWindowPos({layout.left + (width - layout.left) / 2, height - layout.bottom - 44 * scale}, 0,
                              {0.5f, 1});
    ImGui::SetNextWindowBgAlpha(0.8f * most);
    ImGui::Begin("hints", nullptr, overlay_flags | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PushTextWrapPos(room - ImGui::GetStyle().WindowPadding.x);
    bool has_one = false;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
      if (alpha[i] <= 0) continue;
      // Where there is little room, one after the other.
      if (std::exchange(has_one, true) && room < one_at_a_time * scale) break;
      ImVec4 color = ImGui::GetStyleColorVec4(ImGuiCol_Text);
      color.w *= alpha[i];
      ImGui::TextColored(color, "%s", std::string(hints_[i].text).c_str());
    }
    ImGui::PopTextWrapPos();
    ImGui::End();
  }

 private:
  /// s: how long one fades, and when those go that nobody follows.
  static constexpr double fading = 1.5, longest = 60;
  /// Pixels of the picture's width, below which hints come one at a time.
  static constexpr float one_at_a_time = 700;
  /// Of those in which hints and meters, or messages, lie beside each other.
  static constexpr float beside_the_meters = 860;

  struct Hint {
    std::string_view text, verb;  ///< of who has done it
    double fades = longest;       ///< s: when it begins to
  };
  std::vector<Hint> hints_;
};

}  // namespace

std::unique_ptr<Panel> make_hints_panel() { return std::make_unique<HintsPanel>(); }

}  // namespace dreampm::play
