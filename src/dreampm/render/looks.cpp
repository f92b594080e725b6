#include "dreampm/render/looks.h"

#include <algorithm>
#include <array>

#include "dreampm/math/srgb.h"

namespace dreampm::trace {

Vec3f Look::color() const { return linear_color(model_.color); }

std::unique_ptr<const Look> traced(const model::Look& look) {
  using Make = std::unique_ptr<const Look> (*)(const model::Look&);
  struct Row {
    model::LookType type;
    Make make;
  };
#define DM_LOOK_ROW(name) Row{model::LookType::name, &make_##name},
  static constexpr std::array<Row, model::look_type_names.size()> rows{{DM_LOOKS(DM_LOOK_ROW)}};
#undef DM_LOOK_ROW
  return std::ranges::find(rows, look.type, &Row::type)->make(look);
}

}  // namespace dreampm::trace
