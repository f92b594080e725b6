#include "dreampm/play/panels/style.h"

#include <imgui.h>

#include <filesystem>

namespace dreampm::play {

std::string font_file() {
  const std::filesystem::path own = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  if (std::filesystem::exists(own)) return own;
  const auto brought =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../share/dreampm" / own.filename();
  return std::filesystem::exists(brought) ? brought.string() : std::string();
}

void set_style(bool dark) {
  ImGui::GetStyle() = ImGuiStyle();
  if (dark)
    ImGui::StyleColorsDark();
  else
    ImGui::StyleColorsLight();
  ImGuiStyle& s = ImGui::GetStyle();
  s.WindowRounding = 0, s.FrameRounding = 5, s.GrabRounding = 5, s.PopupRounding = 5, s.ScrollbarRounding = 6;
  s.FramePadding = {7, 4}, s.ItemSpacing = {6, 6}, s.WindowPadding = {12, 10};
  s.WindowBorderSize = 0;
  if (!dark) s.Colors[ImGuiCol_WindowBg] = {0.955f, 0.962f, 0.97f, 1};
}

}  // namespace dreampm::play
