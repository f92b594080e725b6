#include "dreampm/solver/projection/body_motion.h"

#include <cmath>

namespace dreampm {

Six along_axis(int axis, const Vec3d& arm) {
  Vec3d unit{};
  unit[axis] = 1;
  const Vec3d turned = cross(arm, unit);
  return {unit.x, unit.y, unit.z, turned.x, turned.y, turned.z};
}

template <class R>
Vec3d arm_to(const World<R>& world, const Collider& collider, const Vec3i& cell, const Vec3d& way) {
  Vec3d arm = world.node_position(cell) + way * world.dx - collider.twist.center;
  const Vec3d size = world.domain().size();
  for (int a = 0; a < 3; ++a)
    if (world.periodic[static_cast<std::size_t>(a)]) arm[a] -= size[a] * std::round(arm[a] / size[a]);
  return arm;
}

SixBySix mass_of(const RigidBody& body, const Collider& collider) {
  SixBySix out{};
  const Mat3d inertia = inertia_now(body, collider);
  for (std::size_t a = 0; a < 3; ++a) {
    out[a][a] = body.mass;
    for (std::size_t b = 0; b < 3; ++b) out[a + 3][b + 3] = inertia(static_cast<int>(a), static_cast<int>(b));
  }
  for (std::size_t a = 0; a < 6; ++a)
    if (body.locked[a])
      for (std::size_t b = 0; b < 6; ++b) out[a][b] = out[b][a] = a == b ? 1 : 0;
  return out;
}

SixBySix response_of(const RigidBody& body, const Collider& collider) {
  SixBySix out = inverse(mass_of(body, collider));
  for (std::size_t a = 0; a < 6; ++a)
    if (body.locked[a]) out[a] = {};
  return out;
}

SixBySix inverse(SixBySix m) {
  // Gauss and Jordan in place; a definite matrix needs no pivots.
  for (std::size_t k = 0; k < 6; ++k) {
    const double pivot = 1 / m[k][k];
    m[k][k] = 1;
    for (double& v : m[k]) v *= pivot;
    for (std::size_t i = 0; i < 6; ++i) {
      if (i == k) continue;
      const double part = m[i][k];
      m[i][k] = 0;
      for (std::size_t j = 0; j < 6; ++j) m[i][j] -= part * m[k][j];
    }
  }
  return m;
}

template Vec3d arm_to(const World<float>&, const Collider&, const Vec3i&, const Vec3d&);
template Vec3d arm_to(const World<double>&, const Collider&, const Vec3i&, const Vec3d&);

}  // namespace dreampm
