#include "dreampm/render/blur.h"

#include <algorithm>
#include <cstdlib>

#include "dreampm/base/parallel.h"

namespace dreampm::trace {

void blur(std::vector<Vec3f>& values, int width, int height, float sigma) {
  const int reach = blur_reach(sigma);
  std::vector<float> weight(static_cast<std::size_t>(reach) + 1);
  float sum = 0;
  for (int i = 0; i <= reach; ++i) {
    const float x = static_cast<float>(i) / sigma;
    sum += (i > 0 ? 2 : 1) * (weight[static_cast<std::size_t>(i)] = std::exp(-0.5f * x * x));
  }
  for (float& w : weight) w /= sum;
  std::vector<Vec3f> half(values.size());
  const auto pass = [&](const std::vector<Vec3f>& in, std::vector<Vec3f>& out, bool across) {
    parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < width; ++x) {
        Vec3f c;
        for (int i = -reach; i <= reach; ++i) {
          const int xx = across ? std::clamp(x + i, 0, width - 1) : x,
                    yy = across ? y : std::clamp(y + i, 0, height - 1);
          c += in[static_cast<std::size_t>(yy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(xx)] *
               weight[static_cast<std::size_t>(std::abs(i))];
        }
        out[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = c;
      }
    });
  };
  pass(values, half, true);
  pass(half, values, false);
}

}  // namespace dreampm::trace
