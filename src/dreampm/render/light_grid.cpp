#include "dreampm/render/light_grid.h"

#include <algorithm>
#include <cmath>

#include "dreampm/base/parallel.h"
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

void LightGrid::blur(float sigma) {
  const int reach = static_cast<int>(std::ceil(2.5f * sigma));
  std::vector<float> weight;
  float sum = 0;
  for (int i = -reach; i <= reach; ++i)
    sum += weight.emplace_back(std::exp(-0.5f * static_cast<float>(i * i) / (sigma * sigma)));
  for (float& w : weight) w /= sum;
  std::vector<Vec3f> half(values.size());
  const auto pass = [&](const std::vector<Vec3f>& in, std::vector<Vec3f>& out, bool across) {
    parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < width; ++x) {
        Vec3f c;
        for (int i = -reach; i <= reach; ++i) {
          const int xx = across ? std::clamp(x + i, 0, width - 1) : x,
                    yy = across ? y : std::clamp(y + i, 0, height - 1);
          c += in[static_cast<std::size_t>(yy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(xx)] *
               weight[static_cast<std::size_t>(i + reach)];
        }
        out[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = c;
      }
    });
  };
  pass(values, half, true);
  pass(half, values, false);
}

}  // namespace dreampm::trace
