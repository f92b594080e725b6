#include "dreampm/backend/body_coupling.h"

#include <cmath>
#include <utility>

namespace dreampm {
namespace {

using Six = std::array<double, 6>;

Six six(const Vec3d& a, const Vec3d& b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

/// Solves m x = r by elimination; `m` is symmetric and positive definite, so that no pivot is zero.
Six solve_six(std::array<Six, 6> m, Six r) {
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t i = k + 1; i < 6; ++i) {
      const double part = m[i][k] / m[k][k];
      for (std::size_t j = k; j < 6; ++j) m[i][j] -= part * m[k][j];
      r[i] -= part * r[k];
    }
  for (std::size_t k = 6; k-- > 0;) {
    for (std::size_t j = k + 1; j < 6; ++j) r[k] -= m[k][j] * r[j];
    r[k] /= m[k][k];
  }
  return r;
}

}  // namespace

template <class R>
void BodyCoupling::begin(const World<R>& world, const Vec3d& kick) {
  bodies_.clear();
  of_collider_.assign(world.rigid.empty() ? 0 : world.colliders.size(), -1);
  for (const RigidBody& body : world.rigid) {
    const Collider& c = world.colliders[body.collider];
    of_collider_[body.collider] = static_cast<std::int32_t>(bodies_.size());
    Body& b = bodies_.emplace_back();
    b.center = c.twist.center, b.velocity = b.free_velocity = c.twist.velocity + kick;
    b.spin = b.free_spin = c.twist.spin;
    b.mass = body.mass, b.inertia = inertia_now(body, c), b.locked = body.locked;
    for (int a = 0; a < 3; ++a) {
      if (b.locked[static_cast<std::size_t>(a)]) b.velocity[a] = b.free_velocity[a] = 0;
      if (b.locked[static_cast<std::size_t>(a) + 3]) b.spin[a] = b.free_spin[a] = 0;
    }
  }
}

void BodyCoupling::add(const Lever& lever, const Response& response) {
  Body& b = bodies_[lever.body];
  const Six j = six(lever.linear, lever.angular);
  for (std::size_t i = 0; i < 6; ++i) {
    b.given[i] += response.impulse * j[i];
    for (std::size_t k = 0; k < 6; ++k) b.matter[i][k] += response.stiffness * j[i] * j[k];
  }
}

void BodyCoupling::solve() {
  for (Body& b : bodies_) {
    const Six missing = six((b.free_velocity - b.velocity) * b.mass, b.inertia * (b.free_spin - b.spin));
    std::array<Six, 6> m = b.matter;
    Six r;
    for (std::size_t i = 0; i < 3; ++i) {
      m[i][i] += b.mass;
      for (std::size_t k = 0; k < 3; ++k) m[i + 3][k + 3] += b.inertia(static_cast<int>(i), static_cast<int>(k));
    }
    for (std::size_t i = 0; i < 6; ++i) r[i] = missing[i] - b.given[i];
    for (std::size_t i = 0; i < 6; ++i) {
      if (!b.locked[i]) continue;
      for (std::size_t k = 0; k < 6; ++k) m[i][k] = m[k][i] = i == k ? 1 : 0;
      r[i] = 0;
    }
    const Six change = solve_six(m, r);
    b.velocity += Vec3d{change[0], change[1], change[2]};
    b.spin += Vec3d{change[3], change[4], change[5]};
    b.given = {}, b.matter = {};
  }
}

template void BodyCoupling::begin(const World<float>&, const Vec3d&);
template void BodyCoupling::begin(const World<double>&, const Vec3d&);

}  // namespace dreampm
