// A point that attracts, or repels if its strength is negative: a = strength d / (|d|^2 + radius^2)^(3/2), d from the
// node to the point; the inverse-square law, softened within `radius` (Plummer 1911, MNRAS 71:460). Its greatest value
// is 0.385 strength / radius^2, at 0.707 radius.
#pragma once
#include "dreampm/math/scalar.h"
#include "dreampm/physics/field.h"

namespace dreampm {

struct Attractor {
  Vec3d point{};        ///< m
  double strength = 0;  ///< m^3/s^2
  double radius = 0.1;  ///< m

  static constexpr std::string_view name = "attractor",
                                    help = "pulls to a point by the inverse square; strength < 0 pushes";
  static constexpr MemberParam<Attractor> params[] = {
      {"point", "m", nullptr, &Attractor::point, -1e9, 1e9, false, true, "where to"},
      {"strength", "m^3/s^2", &Attractor::strength, nullptr, -1e15, 1e15, false, true, "acceleration times distance^2"},
      {"radius", "m", &Attractor::radius, nullptr, 0, 1e9, true, true, "within it the pull softens to 0 at the point"},
  };

  template <class R>
  struct Step {
    Vec3<R> point;
    R gain, radius2;  ///< strength dt

    static Step of(const Attractor& f, double dt) {
      return {static_cast<Vec3<R>>(f.point), static_cast<R>(f.strength * dt), static_cast<R>(f.radius * f.radius)};
    }
    DM_FN Vec3<R> kick(const Vec3<R>& x) const {
      const Vec3<R> d = point - x;
      const R r = sqrt(dot(d, d) + radius2);
      return d * (gain / r / r / r);
    }
    DM_FN Vec3<R> operator()(const Vec3<R>& v, const Vec3<R>& x) const { return v + kick(x); }
    DM_FN R fastest(const R& s, const Vec3<R>& x) const {
      const Vec3<R> k = kick(x);
      return s + sqrt(dot(k, k));
    }
  };
};

}  // namespace dreampm
