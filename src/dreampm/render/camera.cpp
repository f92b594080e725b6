#include "dreampm/render/camera.h"

#include "dreampm/base/error.h"
#include "dreampm/math/camera_view.h"
#include "dreampm/render/color.h"

namespace dreampm::trace {
namespace {

constexpr double film_height = 0.024;  ///< m, of 35 mm film, which f-numbers are said of

double lens_diameter(const model::Camera& camera) {
  if (!camera.fstop) return camera.aperture;
  const double focal_length = 0.5 * film_height / std::tan(0.5 * camera.fov * double(degree));
  return focal_length / *camera.fstop;
}

/// A point of the unit disc, by squares about its middle (Shirley and Chiu 1997).
std::array<float, 2> on_disc(float a, float b) {
  const float u = 2 * a - 1, v = 2 * b - 1;
  if (u == 0 && v == 0) return {0, 0};
  const bool wide = std::fabs(u) > std::fabs(v);
  const float r = wide ? u : v, angle = wide ? 0.25f * pi * (v / u) : 0.5f * pi - 0.25f * pi * (u / v);
  return {r * std::cos(angle), r * std::sin(angle)};
}

}  // namespace

Camera::Camera(const model::Camera& camera, const Box3f& basin, int width, int height)
    : width_(width), height_(height), tan_half_(std::tan(0.5f * static_cast<float>(camera.fov) * degree)) {
  const Box3d box{static_cast<Vec3d>(basin.min), static_cast<Vec3d>(basin.max)};
  const CameraView view = camera_view(camera, box, static_cast<double>(width) / height);
  eye_ = static_cast<Vec3f>(view.eye), forward_ = static_cast<Vec3f>(view.forward);
  right_ = static_cast<Vec3f>(view.right), up_ = static_cast<Vec3f>(view.up);
  lens_radius_ = static_cast<float>(0.5 * lens_diameter(camera));
  const Vec3d sharp = camera.focus_point.value_or(camera.fit_basin ? box.center() : camera.to);
  const double focus = camera.focus.value_or(dot(sharp - view.eye, view.forward));
  if (lens_radius_ > 0 && !(focus > 0))
    fail_input("render.camera.focus lies {:.4g} m behind the eye; give a point that it sees, or a distance above 0",
               -focus);
  focus_ = static_cast<float>(focus);
}

Vec3f Camera::through(float x, float y) const {
  const float w = static_cast<float>(width_), h = static_cast<float>(height_);
  const float u = (2 * x / w - 1) * tan_half_ * w / h, v = (1 - 2 * y / h) * tan_half_;
  return forward_ + right_ * u + up_ * v;
}

CameraRay Camera::ray(float x, float y, float a, float b) const {
  const auto [u, v] = on_disc(a, b);
  const Vec3f off = (right_ * u + up_ * v) * lens_radius_;
  return {eye_ + off, normalized(through(x, y) * focus_ - off)};
}

std::pair<float, float> Camera::project(const Vec3f& p) const {
  const Vec3f q = p - eye_;
  const float w = static_cast<float>(width_), h = static_cast<float>(height_), z = dot(q, forward_) * tan_half_;
  return {0.5f * w * (1 + dot(q, right_) * h / (z * w)), 0.5f * h * (1 - dot(q, up_) / z)};
}

}  // namespace dreampm::trace
