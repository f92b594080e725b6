// Headings with nothing but their settings.
#include <string>

#include "dreampm/play/panels/panel_host.h"

namespace dreampm::play {
namespace {

class SettingsPanel final : public Panel {
 public:
  explicit SettingsPanel(const char* name) : name_(name) {}
  Where where() const override { return Where::left; }
  void draw(const PanelView& view, PanelHost& host) override {
    if (host.heading(name_)) host.controls.draw(view.frame, name_, host);
  }

 private:
  const std::string name_;
};

}  // namespace

std::unique_ptr<Panel> make_brush_panel() { return std::make_unique<SettingsPanel>("Brush"); }
std::unique_ptr<Panel> make_time_panel() { return std::make_unique<SettingsPanel>("Time"); }
std::unique_ptr<Panel> make_picture_panel() { return std::make_unique<SettingsPanel>("Picture"); }

}  // namespace dreampm::play
