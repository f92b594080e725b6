// Linear drag: dv/dt = -rate (v - u), Stokes' law for what is small or slow. Its exact solution
// over a step, v' = u + (v - u) exp(-rate dt), is stable for any rate.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/physics/field.h"

namespace dreampm {

struct Drag {
  double rate = 1;   ///< 1/s
  Vec3d velocity{};  ///< u [m/s]

  static constexpr std::string_view name = "drag", help = "draws velocities to one of its own, at a rate";
  static constexpr MemberParam<Drag> params[] = {
      {"rate", "1/s", &Drag::rate, nullptr, 0, 1e9, false, true, "how fast; 1/rate is the time to 37 %"},
      {"velocity", "m/s", nullptr, &Drag::velocity, -1e6, 1e6, false, false, "where to; at rest if absent"},
  };

  /// Returns the work per mass of a constant acceleration of rate u, that on matter which is held
  /// back: rate (u - v).v is never above rate u.v. Round by round matter comes to u besides. A drag
  /// to rest gives nothing.
  double head(const Passage& p) const {
    return head_of(velocity * rate, p) + (rate > 0 ? head_of_rounds(velocity, p) : 0);
  }

  template <class R>
  struct Step {
    R keep;
    Vec3<R> u;
    R speed;

    static Step of(const Drag& f, double dt) {
      const auto u = static_cast<Vec3<R>>(f.velocity);
      return {exp(static_cast<R>(-f.rate * dt)), u, sqrt(dot(u, u))};
    }
    DM_FN Vec3<R> operator()(const Vec3<R>& v, const Vec3<R>&) const { return u + (v - u) * keep; }
    DM_FN R fastest(const R& s, const Vec3<R>&) const { return speed > s ? speed + (s - speed) * keep : s; }
  };
};

}  // namespace dreampm
