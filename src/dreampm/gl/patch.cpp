#include "dreampm/gl/patch.h"

#include <algorithm>
#include <cmath>

namespace dreampm::gl {

Patch seen_patch(const Camera& camera, const Box3f& box, float margin, int width, int height) {
  float x0 = 1e9f, y0 = 1e9f, x1 = -1e9f, y1 = -1e9f;
  for (int k = 0; k < 8; ++k) {
    const Vec3f corner{(k & 1) ? box.max.x + margin : box.min.x - margin,
                       (k & 2) ? box.max.y + margin : box.min.y - margin,
                       (k & 4) ? box.max.z + margin : box.min.z - margin};
    const auto p = camera.project(corner, width, height);
    if (!p) return {0, 0, width, height};
    x0 = std::min(x0, p->x), x1 = std::max(x1, p->x);
    y0 = std::min(y0, p->y), y1 = std::max(y1, p->y);
  }
  const auto clamped = [](float v, int most) {
    return static_cast<int>(std::clamp(v, 0.0f, static_cast<float>(most)));
  };
  const int left = clamped(x0 - 2, width), right = clamped(x1 + 2, width);
  const int top = clamped(y0 - 2, height), bottom = clamped(y1 + 2, height);
  return {left, height - bottom, right - left, bottom - top};
}

Patch half_patch(const Patch& patch, int width, int height, int more) {
  const int left = std::max(patch.x / 2 - more, 0), low = std::max(patch.y / 2 - more, 0);
  const int right = std::min((patch.x + patch.width + 1) / 2 + more, width);
  const int high = std::min((patch.y + patch.height + 1) / 2 + more, height);
  return {left, low, right - left, high - low};
}

float farthest(const Camera& camera, const Box3f& box, float margin) {
  const Vec3f f = camera.axes().forward, c = box.center() - camera.eye, h = box.size() * 0.5f;
  return dot(c, f) + h.x * std::abs(f.x) + h.y * std::abs(f.y) + h.z * std::abs(f.z) + margin;
}

}  // namespace dreampm::gl
