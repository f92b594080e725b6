// Wind: dv/dt = -k |v - u| (v - u), Newton's quadratic drag of a fast stream. With r = v - u the
// exact solution over a step is r' = r / (1 + k |r| dt), stable for any k. For a drop of radius a:
// k = 3/8 c_d rho_air / (rho a).
#pragma once
#include "dreampm/math/scalar.h"
#include "dreampm/physics/field.h"

namespace dreampm {

struct Wind {
  Vec3d velocity{};        ///< u [m/s]
  double coefficient = 1;  ///< k [1/m]

  static constexpr std::string_view name = "wind", help = "blows, with drag by the square of the speed difference";
  static constexpr MemberParam<Wind> params[] = {
      {"velocity", "m/s", nullptr, &Wind::velocity, -1e6, 1e6, false, true, "of the air"},
      {"coefficient", "1/m", &Wind::coefficient, nullptr, 0, 1e9, false, true, "3/8 c_d rho_air/(rho a) for drops"},
  };

  /// Returns the work per mass of a constant acceleration of k |u| u, that on matter which is held
  /// back: k |u|^2 L over a length L along the wind. With r = |v - u| the power k r (u.v - v^2) is
  /// never above k |u| u.v: where u.v >= v^2, r is at most |u|; where u.v < 0, r is at least |u|;
  /// between the two the wind takes energy. Held back, matter presses with all of that, even where
  /// the way is too short to come near u. Round by round it comes to u besides.
  double head(const Passage& p) const {
    return head_of(velocity * (coefficient * length(velocity)), p) +
           (coefficient > 0 ? head_of_rounds(velocity, p) : 0);
  }

  template <class R>
  struct Step {
    Vec3<R> u;
    R speed, k_dt;

    static Step of(const Wind& f, double dt) {
      const auto u = static_cast<Vec3<R>>(f.velocity);
      return {u, sqrt(dot(u, u)), static_cast<R>(f.coefficient * dt)};
    }
    DM_FN Vec3<R> operator()(const Vec3<R>& v, const Vec3<R>&) const {
      const Vec3<R> r = v - u;
      return u + r * (R(1) / (R(1) + k_dt * sqrt(dot(r, r))));
    }
    // v' lies between v and u, nearer to u the greater |r|, which is at most s + speed.
    DM_FN R fastest(const R& s, const Vec3<R>&) const {
      return speed > s ? speed + (s - speed) / (R(1) + k_dt * (s + speed)) : s;
    }
  };
};

}  // namespace dreampm
