#include "dreampm/backend/body_coupling.h"

#include <Eigen/Cholesky>

namespace dreampm {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Vector6 six(const Vec3d& a, const Vec3d& b) { return (Vector6() << a.x, a.y, a.z, b.x, b.y, b.z).finished(); }

}  // namespace

template <class R>
void BodyCoupling::begin(const World<R>& world, double dt) {
  bodies_.clear();
  const Vec3d kick = world.gravity_over(dt) * dt;
  for (const RigidBody& body : world.rigid) {
    const Collider& c = world.colliders[body.collider];
    const Twist free = free_twist(body, c, kick, dt);
    Body& b = bodies_.emplace_back();
    b.velocity = b.free_velocity = free.velocity;
    b.spin = b.free_spin = free.spin;
    b.mass = body.mass, b.inertia = inertia_now(body, c), b.locked = body.locked;
  }
}

void BodyCoupling::add(const Lever& lever, const Response& response) {
  Body& b = bodies_[lever.body];
  const Vector6 j = six(lever.linear, lever.angular);
  Eigen::Map<Vector6>(b.given.data()) += response.impulse * j;
  Eigen::Map<Matrix6>(b.matter.data()) += response.stiffness * j * j.transpose();
}

void BodyCoupling::solve() {
  for (Body& b : bodies_) {
    Vector6 r = six((b.free_velocity - b.velocity) * b.mass, b.inertia * (b.free_spin - b.spin)) -
                Eigen::Map<Vector6>(b.given.data());
    Matrix6 m = Eigen::Map<Matrix6>(b.matter.data());
    m.diagonal().head<3>().array() += b.mass;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) m(i + 3, k + 3) += b.inertia(i, k);
    for (int i = 0; i < 6; ++i) {
      if (!b.locked[static_cast<std::size_t>(i)]) continue;
      m.row(i).setZero(), m.col(i).setZero();
      m(i, i) = 1, r(i) = 0;
    }
    const Vector6 change = m.ldlt().solve(r);
    b.velocity += Vec3d{change(0), change(1), change(2)};
    b.spin += Vec3d{change(3), change(4), change(5)};
    b.given = {}, b.matter = {};
  }
}

template void BodyCoupling::begin(const World<float>&, double);
template void BodyCoupling::begin(const World<double>&, double);

}  // namespace dreampm
