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

Box3d Collider::bounds() const {
  const Box3d own = shape->bounds();
  if (!moves()) return own;
  constexpr double endless = std::numeric_limits<double>::infinity();
  Box3d all;
  if (pose.rotation == Quaternion{}) {
    all.min = own.min + pose.position, all.max = own.max + pose.position;
  } else if (is_finite(own.min) && is_finite(own.max)) {
    for_corners(own, [&](const Vec3d& p) { all.add(pose(p)); });
  } else {
    all.min = {-endless, -endless, -endless}, all.max = {endless, endless, endless};
  }
  return all;
}

double Collider::fastest(const Box3d& domain) const {
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
