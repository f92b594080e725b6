#include "dreampm/render/light_grid.h"

#include <algorithm>
#include <cmath>

#include "dreampm/render/blur.h"
#include "dreampm/render/color.h"

namespace dreampm::trace {

LightGrid LightGrid::covering(float wide, float deep, float cell) {
  LightGrid g;
  g.cell = cell;
  g.width = std::max(2, static_cast<int>(std::ceil(wide / cell)));
  g.height = std::max(2, static_cast<int>(std::ceil(deep / cell)));
  g.values.assign(static_cast<std::size_t>(g.width) * static_cast<std::size_t>(g.height), {});
  return g;
}

Vec3f LightGrid::at(float u, float v) const {
  u = std::clamp(u - 0.5f, 0.0f, static_cast<float>(width) - 1.001f);
  v = std::clamp(v - 0.5f, 0.0f, static_cast<float>(height) - 1.001f);
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const Vec3f* p = &values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  const float fx = u - static_cast<float>(x);
  return mix(mix(p[0], p[1], fx), mix(p[width], p[width + 1], fx), v - static_cast<float>(y));
}

void LightGrid::blur(float sigma) { trace::blur(values, width, height, sigma); }

}  // namespace dreampm::trace
