#include "dreampm/render/camera.h"

#include "dreampm/math/camera_view.h"
#include "dreampm/render/color.h"

namespace dreampm::trace {

Camera::Camera(const model::Camera& camera, const Box3f& basin, int width, int height)
    : width_(width), height_(height), tan_half_(std::tan(0.5f * static_cast<float>(camera.fov) * degree)) {
  const Box3d box{static_cast<Vec3d>(basin.min), static_cast<Vec3d>(basin.max)};
  const CameraView view = camera_view(camera, box, static_cast<double>(width) / height);
  eye_ = static_cast<Vec3f>(view.eye), forward_ = static_cast<Vec3f>(view.forward);
  right_ = static_cast<Vec3f>(view.right), up_ = static_cast<Vec3f>(view.up);
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
