#include "dreampm/render/camera.h"

#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

Vec3f corner(const Box3f& b, int k) {
  return {(k & 1) != 0 ? b.max.x : b.min.x, (k & 2) != 0 ? b.max.y : b.min.y, (k & 4) != 0 ? b.max.z : b.min.z};
}

}  // namespace

Camera::Camera(const RenderCamera& wish, const Box3f& basin, int width, int height)
    : width_(width), height_(height), tan_half_(std::tan(0.5f * wish.fov * degree)) {
  if (wish.fit_basin) {
    const float a = wish.azimuth * degree, e = wish.elevation * degree;
    forward_ = -Vec3f{std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
  } else {
    eye_ = wish.from;
    forward_ = normalized(wish.to - wish.from);
  }
  right_ = normalized(cross(forward_, std::fabs(forward_.y) < 0.9999f ? Vec3f{0, 1, 0} : Vec3f{0, 0, -1}));
  up_ = cross(right_, forward_);
  if (wish.fit_basin) fit(basin, wish.fill);
}

void Camera::fit(const Box3f& basin, float fill) {
  const float aspect = static_cast<float>(width_) / static_cast<float>(height_);
  // nearer than this a corner would lie behind the eye
  const float nearest = 0.55f * length(basin.size());
  Vec3f aim = basin.center();
  float distance = 2 * length(basin.size());
  for (int round = 0; round < 40; ++round) {
    eye_ = aim - forward_ * distance;
    float x0 = 1e9f, x1 = -1e9f, y0 = 1e9f, y1 = -1e9f;
    for (int k = 0; k < 8; ++k) {
      const Vec3f q = corner(basin, k) - eye_;
      const float z = dot(q, forward_) * tan_half_, x = dot(q, right_) / (z * aspect), y = dot(q, up_) / z;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
    const float half_height = distance * tan_half_;
    aim += right_ * (0.5f * (x0 + x1) * half_height * aspect) + up_ * (0.5f * (y0 + y1) * half_height);
    const float size = 0.5f * std::max(x1 - x0, y1 - y0);
    distance = std::max(nearest, distance * (0.5f + 0.5f * size / fill));
  }
  eye_ = aim - forward_ * distance;
}

Vec3f Camera::direction(float x, float y) const {
  const float w = static_cast<float>(width_), h = static_cast<float>(height_);
  const float u = (2 * x / w - 1) * tan_half_ * w / h, v = (1 - 2 * y / h) * tan_half_;
  return normalized(forward_ + right_ * u + up_ * v);
}

std::pair<float, float> Camera::project(const Vec3f& p) const {
  const Vec3f q = p - eye_;
  const float w = static_cast<float>(width_), h = static_cast<float>(height_), z = dot(q, forward_) * tan_half_;
  return {0.5f * w * (1 + dot(q, right_) * h / (z * w)), 0.5f * h * (1 - dot(q, up_) / z)};
}

}  // namespace dreampm::trace
