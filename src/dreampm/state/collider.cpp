#include "dreampm/state/collider.h"

#include <algorithm>
#include <limits>

namespace dreampm {
namespace {

template <class Body>
void for_corners(const Box3d& box, const Body& body) {
  for (int corner = 0; corner < 8; ++corner)
    body(Vec3d{corner & 4 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
               corner & 1 ? box.max.z : box.min.z});
}

}  // namespace

void Collider::advance(double dt) {
  if (twist.at_rest()) return;
  const Quaternion turn = Quaternion::about(twist.spin * dt);
  const Vec3d center = twist.center + twist.velocity * dt;
  pose.position = center + turn(pose.position - twist.center);
  pose.rotation = (turn * pose.rotation).normalized();
  twist.center = center;
}

void Collider::follow(double from, double dt) {
  if (changing) time = from;
  if (!path) return;
  pose = path->pose_at(from);
  twist = path->twist_over(from, from + dt);
}

void Collider::settle(double tolerance) {
  const Box3d own = shape->bounds();
  bool off = !is_finite(own.min) || !is_finite(own.max);
  for_corners(own, [&](const Vec3d& p) { off = off || length(pose(p) - surface_pose(p)) > tolerance; });
  if (off) surface_pose = pose;
  if (!changing || surface_time == time) return;
  if (changing->farthest(surface_time, time) > tolerance) surface_time = time, take_shape();
}

Box3d Collider::bounds() const {
  const Box3d own = shape->bounds();
  if (!moves()) return own;
  constexpr double endless = std::numeric_limits<double>::infinity();
  Box3d all;
  if (surface_pose.rotation == Quaternion{}) {
    all.min = own.min + surface_pose.position, all.max = own.max + surface_pose.position;
  } else if (is_finite(own.min) && is_finite(own.max)) {
    for_corners(own, [&](const Vec3d& p) { all.add(surface_pose(p)); });
  } else {
    all.min = {-endless, -endless, -endless}, all.max = {endless, endless, endless};
  }
  return all;
}

double Collider::fastest(const Box3d& domain, double from, double ahead) const {
  if (changing) return changing->fastest(from, from + ahead);
  if (path) {
    const MotionPath::Fastest most = path->fastest_within(from, from + ahead);
    double reach = 0;
    for_corners(domain, [&](const Vec3d& p) { reach = std::max(reach, length(p - twist.center)); });
    double size = 0;
    const Box3d own = shape->bounds();
    for_corners(own, [&](const Vec3d& p) { size = std::max(size, length(p - path->center)); });
    return most.speed + most.spin * std::min(reach, size);
  }
  if (twist.at_rest()) return 0;
  const Box3d all = bounds();
  const Box3d within{max(all.min, domain.min), min(all.max, domain.max)};
  if (within.empty()) return 0;
  // Speed is convex: it is largest at a corner.
  double speed = 0;
  for_corners(within, [&](const Vec3d& p) { speed = std::max(speed, length(twist.at(p))); });
  return speed;
}

}  // namespace dreampm
