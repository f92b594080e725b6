#include "dreampm/gl/camera.h"

#include <algorithm>
#include <cmath>

namespace dreampm::gl {

namespace {
constexpr float shortest = 1e-3f, longest = 1e3f;  // m, between eye and target
constexpr float steepest = 89 * std::numbers::pi_v<float> / 180;
}  // namespace

float Camera::distance() const { return std::max(length(eye - target), shortest); }

// Planes go with the distance: 24 bits of depth then resolve 1e-5 of it at the target.
float Camera::near_plane() const { return 0.01f * distance(); }
float Camera::far_plane() const { return 1000 * distance(); }

ViewAxes Camera::axes() const {
  Vec3f forward = normalized(target - eye);
  if (!(length2(forward) > 0.5f)) forward = {0, 0, -1};
  Vec3f right = cross(forward, Vec3f{0, 1, 0});
  right = length2(right) > 1e-12f ? normalized(right) : Vec3f{1, 0, 0};
  return {right, cross(right, forward), forward};
}

Mat4f Camera::view() const {
  const auto [r, u, f] = axes();
  return {r.x, u.x, -f.x, 0, r.y, u.y, -f.y, 0, r.z, u.z, -f.z, 0, -dot(r, eye), -dot(u, eye), dot(f, eye), 1};
}

Mat4f Camera::projection(float aspect) const {
  const float slope = 1 / std::tan(0.5f * view_angle), n = near_plane(), f = far_plane();
  return {slope / aspect, 0, 0, 0, 0, slope, 0, 0, 0, 0, (f + n) / (n - f), -1, 0, 0, 2 * f * n / (n - f), 0};
}

void Camera::orbit(float right, float up) {
  const Vec3f arm = eye - target;
  const float d = distance();
  const float azimuth = std::atan2(arm.x, arm.z) + right;
  const float elevation = std::clamp(std::asin(std::clamp(arm.y / d, -1.0f, 1.0f)) + up, -steepest, steepest);
  eye = target + d * Vec3f{std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                           std::cos(elevation) * std::cos(azimuth)};
}

void Camera::pan(float right, float up) {
  const ViewAxes a = axes();
  const float height = 2 * distance() * std::tan(0.5f * view_angle);
  const Vec3f shift = (a.right * right + a.up * up) * height;
  eye += shift;
  target += shift;
}

void Camera::zoom(float factor) {
  const float d = std::clamp(distance() * factor, shortest, longest);
  eye = target - axes().forward * d;
}

float Camera::pixels_per_slope(int height) const {
  return 0.5f * static_cast<float>(height) / std::tan(0.5f * view_angle);
}

Ray Camera::ray(float x, float y, int width, int height) const {
  const ViewAxes a = axes();
  const float scale = 1 / pixels_per_slope(height);
  const float right = (x - 0.5f * static_cast<float>(width)) * scale;
  const float up = (0.5f * static_cast<float>(height) - y) * scale;
  return {eye, normalized(a.forward + a.right * right + a.up * up)};
}

std::optional<Projected> Camera::project(const Vec3f& p, int width, int height) const {
  const ViewAxes a = axes();
  const Vec3f arm = p - eye;
  const float depth = dot(arm, a.forward);
  if (!(depth > near_plane())) return std::nullopt;
  const float scale = pixels_per_slope(height) / depth;
  return Projected{0.5f * static_cast<float>(width) + dot(arm, a.right) * scale,
                   0.5f * static_cast<float>(height) - dot(arm, a.up) * scale, depth};
}

}  // namespace dreampm::gl
