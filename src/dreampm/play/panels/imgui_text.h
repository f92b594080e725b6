// What the files of the panels share: colors and names as Dear ImGui takes them.
#pragma once
#include <imgui.h>

#include <algorithm>
#include <string>

#include "dreampm/play/model/number_text.h"
#include "dreampm/vec.h"

namespace dreampm::play {

/// sRGB, 0 to 1.
inline ImU32 color_of(const Vec3f& c, float alpha = 1) {
  return ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, alpha});
}

/// Of what lies over the picture.
inline constexpr ImGuiWindowFlags overlay_flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                                                  ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                                  ImGuiWindowFlags_NoFocusOnAppearing;

/// Of windows in the middle, or of their kind.
inline constexpr ImGuiWindowFlags dialog_flags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                                                 ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove;
inline void place_in_the_middle() {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({window.x / 2, window.y / 2}, 0, {0.5f, 0.5f});
}
inline constexpr Vec3f film_red{0.86f, 0.16f, 0.16f};
inline ImVec4 warning_orange() { return {0.95f, 0.55f, 0.2f, 1}; }

/// Blanks would part the words of an action.
inline std::string without_blanks(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

}  // namespace dreampm::play
