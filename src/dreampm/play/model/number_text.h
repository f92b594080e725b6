// Numbers with their units, as panels show them.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace dreampm::play {

/// Short enough for a slider.
inline std::string value_text(double value) {
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-4 || size >= 1e6)) return fmt::format("{:.3g}", value);
  return size >= 1e4 ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

/// With raised exponents, where the font has them.
inline std::string unit_text(std::string unit) {
  for (const auto& [plain, raised] : {std::pair{"^2", "\u00b2"}, {"^3", "\u00b3"}})
    for (auto at = unit.find(plain); at != std::string::npos; at = unit.find(plain)) unit.replace(at, 2, raised);
  return unit;
}

/// "20 kPa" for 20,000 Pa; other units as they are.
inline std::string with_unit(double value, const std::string& unit) {
  if (unit.empty()) return value_text(value);
  if (unit == "Pa" && std::abs(value) >= 1e4)
    for (const auto& [factor, name] : {std::pair{1e9, "GPa"}, {1e6, "MPa"}, {1e3, "kPa"}})
      if (std::abs(value) >= factor) return fmt::format("{:.4g} {}", value / factor, name);
  return fmt::format("{} {}", value_text(value), unit_text(unit));
}

}  // namespace dreampm::play
