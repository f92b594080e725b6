#include "dreampm/render/absorption.h"

#include <algorithm>
#include <cmath>

#include "dreampm/render/color.h"

namespace dreampm {
namespace {

constexpr float most_steps = 512;

}  // namespace

Vec3f AbsorptionField::at(const Vec3f& p) const {
  const Vec3f u = (p - corner) / cell - Vec3f{0.5f, 0.5f, 0.5f};
  std::array<int, 3> low, high;
  Vec3f share;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const float x = std::clamp(u[a], 0.0f, static_cast<float>(size[k] - 1));
    low[k] = static_cast<int>(x), high[k] = std::min(low[k] + 1, size[k] - 1);
    share[a] = x - static_cast<float>(low[k]);
  }
  const auto along = [&](int y, int z) {
    return trace::mix(values[index(low[0], y, z)], values[index(high[0], y, z)], share.x);
  };
  return trace::mix(trace::mix(along(low[1], low[2]), along(high[1], low[2]), share.y),
                    trace::mix(along(low[1], high[2]), along(high[1], high[2]), share.y), share.z);
}

Vec3f AbsorptionField::left(const Vec3f& o, const Vec3f& d, float t) const {
  const float steps = std::clamp(std::ceil(t / cell), 1.0f, most_steps), each = t / steps;
  Vec3f sum;
  for (float k = 0.5f; k < steps; ++k) sum += at(o + d * (k * each));
  return trace::transmission(sum, each);
}

}  // namespace dreampm
