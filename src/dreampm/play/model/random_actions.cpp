#include "dreampm/play/model/random_actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dreampm/math/rng.h"
#include "dreampm/play/model/matter.h"
#include "dreampm/play/model/stories.h"
#include "dreampm/play/panels/panels.h"
#include "dreampm/scene/description.h"

namespace dreampm::play {

double RandomActions::random(double low, double high) { return low + (high - low) * uniform(seed_, drawn_++); }

std::size_t RandomActions::index(std::size_t count) {
  return std::min(static_cast<std::size_t>(random(0, static_cast<double>(count))), count - 1);
}

Action RandomActions::open() {
  const std::size_t n = index(stories().size() + 2);
  if (n < stories().size()) return {"open", {std::string(stories()[n].name)}};
  return {"open", {"report", n == stories().size() ? "1" : "2"}};
}

Action RandomActions::next(const Frame& frame) {
  const Vec3d low = frame.domain.min, size = frame.domain.size();
  const double reach = std::min({size.x, size.y, size.z});
  const auto place = [&] {
    return fmt::format("{} {} {}", random(low.x, low.x + size.x), random(low.y, low.y + size.y),
                       random(low.z, low.z + size.z));
  };
  const auto radius = [&](double least, double most) { return text_of(reach * random(least, most)); };
  switch (index(24)) {
    default: {
      // A control; time stands still seldom.
      const ControlInfo& c = (*frame.controls)[index(frame.controls->size())];
      if (c.id == "paused") return {"set", {c.id, "0"}};
      const double value = c.choices.empty() ? random(c.min, c.max) : static_cast<double>(index(c.choices.size()));
      return {"set", {c.id, text_of(std::clamp(value, c.min, c.max))}};
    }
    case 0:
    case 1:
      return Action::parse(
          fmt::format("push {} {} {} {} {}", place(), radius(0.1, 0.4), random(-5, 5), random(-5, 5), random(-5, 5)));
    case 2:
      return Action::parse(fmt::format("grab {} {}", place(), radius(0.1, 0.3)));
    case 3:
      return Action::parse("pull " + place());
    case 4:
      return {"release", {}};
    case 5:
    case 6:
      return Action::parse(fmt::format("pour {} {} {} {} {}", place(), radius(0.05, 0.2), random(-2, 2),
                                       random(-4, -0.5), random(-2, 2)));
    case 7:
      return {"pour", {"off"}};
    case 8: {
      // Files take their time.
      static constexpr std::string_view things[] = {"box", "sphere", "crate", "brick", "ball"};
      return Action::parse(fmt::format("drop {} {} {}", things[index(std::size(things))], place(), radius(0.1, 0.4)));
    }
    case 9:
      return Action::parse(fmt::format("erase {} {}", place(), radius(0.1, 0.5)));
    case 10:
      return Action::parse(
          fmt::format("cut {} {} {} {} {}", place(), random(-1, 1), random(-1, 1), random(-1, 1), 2 * reach));
    case 11:
      return Action::parse(fmt::format("pin {} {}", place(), radius(0.05, 0.3)));
    case 12:
      return {"pin", {"off"}};
    case 13:
      return Action::parse(fmt::format("shake {} {} {}", random(-20, 20), random(-20, 20), random(-20, 20)));
    case 14:
      return {"undo", {}};
    case 15:
      return {"redo", {}};
    case 16:
      return {"seek", {text_of(random(0, 3))}};
    case 19: {
      if (index(4) == 0) return {"wall", {"off"}};
      const std::size_t side = index(6);
      const int axis = static_cast<int>(side) / 2;
      const double in = random(0, 0.6) * size[axis];
      return {"wall", {scene::wall_names.at(side), text_of(side % 2 ? low[axis] + size[axis] - in : low[axis] + in)}};
    }
    case 18:
      if (!frame.other)
        return index(6) == 0 ? compare_with(static_cast<double>(index(matters().size() + 1))) : Action{"step", {}};
      return {"compare", index(3) == 0   ? std::vector<std::string>{"off"}
                         : index(2) == 0 ? std::vector<std::string>{"side", "A"}
                                         : std::vector<std::string>{"side", "B"}};
    case 17:
      return index(4) == 0 ? Action{"restart", {}} : Action{"step", {}};
  }
}

}  // namespace dreampm::play
