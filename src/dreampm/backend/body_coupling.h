// Rigid bodies in the contact solve: their velocities are unknowns of it beside the impulses at the
// points of their surfaces. An impulse afterwards would let a light body be thrown by the water
// whose mass it has to take along.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dreampm/backend/body_sums.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// One step of the solve for the bodies. The velocities of all bodies together minimise, with the
/// impulses, the change of kinetic energy: M (V - V*) = - sum_s l_s A_s J_s, where V* is the
/// velocity without matter, and J_s V the speed of point s along its normal. The impulses follow V
/// only in the next steps of their descent; so V is moved by (M + S)^-1 of what is missing, where
/// S = sum_s e_s A_s J_s J_s^T stands for the matter that has to come along, e_s being the impulse
/// per velocity of the descent.
class BodyCoupling {
 public:
  /// A contact point of a body.
  struct Lever {
    std::uint32_t body;
    Vec3d linear, angular;  ///< J_s: of the center's velocity [1] and of the spin [m]
  };
  /// The impulse of a point, and its response.
  struct Response {
    double impulse = 0;    ///< l_s A_s [N s]
    double stiffness = 0;  ///< e_s A_s [kg]; 0 where the point does not act
  };

  /// Begins a solve of a step of `dt` [s].
  template <class R>
  void begin(const World<R>& world, double dt);
  bool any() const { return !bodies_.empty(); }
  /// Adds a point, or points that were summed elsewhere; then solve() moves the bodies.
  void add(const Lever& lever, const Response& response);
  void add(std::size_t body, const BodySums& sums) { bodies_[body].sums.add(sums); }
  void solve();
  /// The speed of a point along its normal, as its nodes would have it [m/s].
  double speed(const Lever& lever) const {
    const Body& b = bodies_[lever.body];
    return dot(lever.linear, b.velocity) + dot(lever.angular, b.spin);
  }
  /// Of the center of a body [m/s], and its spin [rad/s].
  const Vec3d& velocity(std::size_t body) const { return bodies_[body].velocity; }
  const Vec3d& spin(std::size_t body) const { return bodies_[body].spin; }

 private:
  struct Body {
    Vec3d velocity, spin, free_velocity, free_spin;
    double mass;
    Mat3d inertia;
    std::array<bool, 6> locked;
    BodySums sums = BodySums::none();
  };
  std::vector<Body> bodies_;
};

}  // namespace dreampm
