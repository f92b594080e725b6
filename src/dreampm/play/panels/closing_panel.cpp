// What becomes of a film under way when the window closes.
#include <imgui.h>

#include <string>

#include "dreampm/play/panels/imgui_text.h"
#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class ClosingPanel final : public Panel {
 public:
  Where where() const override { return Where::over; }
  bool may_close(const Frame& frame) override {
    if (closes_ || !frame.rendering || frame.rendering->state != RenderStatus::State::running) return true;
    asks_ = true;
    return false;
  }
  bool asks_to_close() const override { return asks_; }
  void draw(const PanelView& view, PanelHost& host) override {
    if (!asks_) return;
    const Frame& frame = view.frame;
    place_in_the_middle();
    ImGui::Begin("A film is under way", nullptr, dialog_flags);
    const std::string scene = frame.rendering ? frame.rendering->scene : "";
    ImGui::Text("Stopped, dreampm make %s goes on with it.", scene.c_str());
    const auto button = [&](const char* name, const char* place) {
      const bool pressed = ImGui::Button(name);
      host.note_place(place);
      ImGui::SameLine();
      return pressed;
    };
    if (button("Stop it and close", "close stop")) closes_ = true;
    if (button("Close, and let it go on", "close leave")) host.post("render", {"leave"}), closes_ = true;
    if (button("Stay", "close stay")) asks_ = false;
    ImGui::End();
  }

 private:
  bool asks_ = false, closes_ = false;
};

}  // namespace

std::unique_ptr<Panel> make_closing_panel() { return std::make_unique<ClosingPanel>(); }

}  // namespace dreampm::play
