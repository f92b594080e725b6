#include "dreampm/play/tools/gesture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dreampm/gl/pick.h"

namespace dreampm::play {

Vec3d ray_at(const gl::Ray& ray, double t) {
  return static_cast<Vec3d>(ray.origin) + static_cast<Vec3d>(ray.direction) * t;
}

Vec3d clamped(const Vec3d& p, const Box3d& box, double margin) {
  const Vec3d m{margin, margin, margin};
  return max(box.min + m, min(box.max - m, p));
}

gl::Camera camera_of(const Frame& frame) {
  gl::Camera camera;
  camera.eye = static_cast<Vec3f>(frame.eye), camera.target = static_cast<Vec3f>(frame.target);
  camera.view_angle = static_cast<float>(frame.view_angle);
  return camera;
}

Hit pick(const Frame& frame, const gl::Ray& ray) {
  std::optional<float> nearest;
  for (const MatterFrame& m : frame.matter)
    if (const auto t = gl::first_sphere(ray, m.position, static_cast<float>(frame.spacing));
        t && (!nearest || *t < *nearest))
      nearest = t;
  for (const BodyFrame& b : frame.bodies) {
    if (!b.rigid) continue;
    const gl::Ray own{static_cast<Vec3f>(b.pose.inverse(static_cast<Vec3d>(ray.origin))),
                      static_cast<Vec3f>(b.pose.rotation.inverse()(static_cast<Vec3d>(ray.direction)))};
    if (const auto t = gl::first_triangle(own, b.mesh->vertices, b.mesh->triangles); t && (!nearest || *t < *nearest))
      nearest = t;
  }
  if (nearest) return {ray_at(ray, static_cast<double>(*nearest)), true};
  const auto direction = static_cast<Vec3d>(ray.direction);
  if (const double t = (frame.domain.min.y - static_cast<double>(ray.origin.y)) / direction.y;
      std::isfinite(t) && t > 0)
    if (const Vec3d at = ray_at(ray, t); at.x >= frame.domain.min.x && at.x <= frame.domain.max.x &&
                                         at.z >= frame.domain.min.z && at.z <= frame.domain.max.z)
      return {at, false};
  const Vec3d to_middle = frame.domain.center() - static_cast<Vec3d>(ray.origin);
  const double depth = length(to_middle);
  const double share = dot(direction, to_middle) / depth;
  return {clamped(ray_at(ray, depth / std::max(share, 0.1)), frame.domain, frame.spacing), false};
}

gl::Camera Gesture::seen_by() const {
  gl::Camera wide = camera;
  wide.view_angle = 2 * std::atan(std::tan(camera.view_angle / 2) * static_cast<float>(widen));
  return wide;
}

gl::Ray Gesture::ray(double at_x, double at_y) const {
  return seen_by().ray(static_cast<float>(at_x), static_cast<float>(at_y), width, height);
}

Vec3d Gesture::on_drag_plane() const {
  const gl::Ray r = ray();
  const Vec3d forward = static_cast<Vec3d>(camera.axes().forward), eye = static_cast<Vec3d>(camera.eye);
  const double depth = dot(from - eye, forward);
  return ray_at(r, depth / std::max(dot(static_cast<Vec3d>(r.direction), forward), 1e-3));
}

std::optional<CursorMark> Gesture::ring() const {
  const auto radius = static_cast<float>(settings.radius);
  const Vec3f to_eye = -camera.axes().forward;
  if (is_drag) return CursorMark{static_cast<Vec3f>(on_drag_plane()), to_eye, radius};
  if (!hit) return std::nullopt;
  return CursorMark{static_cast<Vec3f>(hit->at), hit->matter ? to_eye : Vec3f{0, 1, 0}, radius};
}

void Gesture::post(std::string verb, const std::vector<double>& numbers, std::string word) {
  Action action{std::move(verb), {}};
  if (!word.empty()) action.words.push_back(std::move(word));
  for (const double n : numbers) action.words.push_back(text_of(n));
  send(std::move(action));
}

}  // namespace dreampm::play
