// What the files of the panels share: colors and numbers as Dear ImGui takes them.
#pragma once
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dreampm/vec.h"

namespace dreampm::play {

/// sRGB, 0 to 1.
inline ImU32 color_of(const Vec3f& c, float alpha = 1) {
  return ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, alpha});
}

/// Short enough for a slider.
inline std::string value_text(double value) {
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-3 || size >= 1e5)) return fmt::format("{:.2e}", value);
  return fmt::format("{:.4g}", value);
}

/// With raised exponents, where the font has them.
inline std::string unit_text(std::string unit) {
  for (const auto& [plain, raised] : {std::pair{"^2", "\u00b2"}, {"^3", "\u00b3"}})
    for (auto at = unit.find(plain); at != std::string::npos; at = unit.find(plain)) unit.replace(at, 2, raised);
  return unit;
}

/// Blanks would part the words of an action.
inline std::string without_blanks(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

}  // namespace dreampm::play
