// A point that attracts, or repels if its strength is negative: a = strength d / (|d|^2 +
// radius^2)^(3/2), d from the node to the point; the inverse-square law, softened within `radius`
// (Plummer 1911, MNRAS 71:460). Its greatest value is 0.385 strength / radius^2, at 0.707 radius.
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

  /// The potential -strength / sqrt(|d|^2 + radius^2), whose slope the law is, from the place of
  /// `from` where it is highest to that of `within` where it is lowest: to the nearest from the
  /// farthest if it pulls, the other way round if it pushes.
  double head(const Passage& p) const {
    // 1/m, of a place at d from the point
    const auto inverse = [this](const Vec3d& d) { return 1 / sqrt(dot(d, d) + radius * radius); };
    const auto near = [&](const Box3d& box) { return inverse(max(max(box.min - point, point - box.max), Vec3d{})); };
    const auto far = [&](const Box3d& box) { return inverse(max(point - box.min, box.max - point)); };
    const double head = strength * (strength > 0 ? near(p.within) - far(p.from) : far(p.within) - near(p.from));
    return head > 0 ? head : 0;
  }

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
