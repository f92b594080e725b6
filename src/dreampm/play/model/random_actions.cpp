#include "dreampm/play/model/random_actions.h"

#include <fmt/format.h>

#include <algorithm>

#include "dreampm/math/rng.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/tools/tool.h"

namespace dreampm::play {
namespace {

/// Of the chances of tools, those of what is no tool's, and of settings.
constexpr int chance_of_others = 5, chance_of_settings = 4;

}  // namespace

double RandomActions::number(double low, double high) { return low + (high - low) * uniform(seed_, drawn_++); }

std::size_t RandomActions::index(std::size_t count) {
  return std::min(static_cast<std::size_t>(number(0, static_cast<double>(count))), count - 1);
}

std::string RandomActions::place(const Frame& frame) {
  const Vec3d low = frame.domain.min, size = frame.domain.size();
  const double x = number(low.x, low.x + size.x), y = number(low.y, low.y + size.y), z = number(low.z, low.z + size.z);
  return fmt::format("{} {} {}", x, y, z);
}

std::string RandomActions::length(const Frame& frame, double least, double most) {
  const Vec3d size = frame.domain.size();
  return " " + text_of(std::min({size.x, size.y, size.z}) * number(least, most));
}

std::string RandomActions::vector(double low, double high) {
  const double x = number(low, high), y = number(low, high), z = number(low, high);
  return fmt::format(" {} {} {}", x, y, z);
}

Action RandomActions::open() {
  const std::size_t n = index(stories().size() + 2);
  if (n < stories().size()) return {"open", {std::string(stories()[n].name)}};
  return {"open", {"report", n == stories().size() ? "1" : "2"}};
}

Action RandomActions::setting(const Frame& frame) {
  // Time stands still seldom.
  const ControlInfo& c = (*frame.controls)[index(frame.controls->size())];
  if (c.id == "paused") return {"set", {c.id, "0"}};
  const double value = c.choices.empty() ? number(c.min, c.max) : static_cast<double>(index(c.choices.size()));
  return {"set", {c.id, text_of(std::clamp(value, c.min, c.max))}};
}

Action RandomActions::other(const Frame& frame) {
  const Action step = index(4) == 0 ? Action{"restart", {}} : Action{"step", {}};
  switch (index(chance_of_others)) {
    case 0:
      return {"undo", {}};
    case 1:
      return {"redo", {}};
    case 2:
      return {"seek", {text_of(number(0, 3))}};
    case 3:
      return step;
    default:
      if (!frame.other) return index(6) == 0 ? compare_with(index(matters().size() + 1)) : step;
      if (index(3) == 0) return {"compare", {"off"}};
      return {"compare", {"side", index(2) == 0 ? "A" : "B"}};
  }
}

Action RandomActions::next(const Frame& frame) {
  static const ToolSet tools;
  int all = chance_of_others + chance_of_settings;
  for (const auto& tool : tools) all += tool->info().chance;
  int drawn = static_cast<int>(index(static_cast<std::size_t>(all)));
  for (const auto& tool : tools)
    if ((drawn -= tool->info().chance) < 0) return tool->random(*this, frame);
  return drawn < chance_of_others ? other(frame) : setting(frame);
}

}  // namespace dreampm::play
