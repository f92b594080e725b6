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
  bodies_[lever.body].sums.add_point(lever.linear, lever.angular, response.impulse, response.stiffness);
}

void BodyCoupling::solve() {
  for (Body& b : bodies_) {
    Vector6 r = six((b.free_velocity - b.velocity) * b.mass, b.inertia * (b.free_spin - b.spin)) -
                Eigen::Map<const Vector6>(b.sums.given);
    Matrix6 m = Matrix6::Zero();  // the solver reads its lower half
    for (int i = 0, n = 0; i < 6; ++i)
      for (int k = 0; k <= i; ++k) m(i, k) = b.sums.matter[n++];
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
    b.sums = BodySums::none();
  }
}

template void BodyCoupling::begin(const World<float>&, double);
template void BodyCoupling::begin(const World<double>&, double);

}  // namespace dreampm
