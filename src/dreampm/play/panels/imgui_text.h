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

/// Blanks would part the words of an action.
inline std::string without_blanks(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

}  // namespace dreampm::play
