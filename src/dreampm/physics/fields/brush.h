// A brush: within a sphere dv/dt = -rate w (v - u), w = (1 - d^2/radius^2)^2 of the distance d from
// its point; what lies inside is taken along. Its exact solution over a step, v' = u + (v - u)
// exp(-rate w dt), is stable for any rate.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/math/scalar.h"
#include "dreampm/physics/field.h"

namespace dreampm {

struct Brush {
  Vec3d point{};        ///< m
  double radius = 0.1;  ///< m
  Vec3d velocity{};     ///< u [m/s]
  double rate = 100;    ///< 1/s

  static constexpr std::string_view name = "brush", help = "takes along what lies within a sphere";
  static constexpr MemberParam<Brush> params[] = {
      {"point", "m", nullptr, &Brush::point, -1e9, 1e9, false, true, "its middle"},
      {"radius", "m", &Brush::radius, nullptr, 0, 1e9, true, true, "it grows weaker towards it, and ends there"},
      {"velocity", "m/s", nullptr, &Brush::velocity, -1e6, 1e6, false, false, "where to; at rest if absent"},
      {"rate", "1/s", &Brush::rate, nullptr, 0, 1e9, false, false, "how fast at its middle; 100 if absent"},
  };

  Box3d bounds() const { return {point - Vec3d{radius, radius, radius}, point + Vec3d{radius, radius, radius}}; }

  /// Returns the work per mass of a constant acceleration of rate u, that on matter which is held
  /// back, over its own width. Matter that goes round comes to u besides.
  double head(const Passage& p) const {
    const Box3d box = bounds();
    Passage inside = p;
    inside.within = {max(p.within.min, box.min), min(p.within.max, box.max)};
    inside.from = {max(p.from.min, inside.within.min), min(p.from.max, inside.within.max)};
    if (inside.within.empty()) return 0;
    // Matter of elsewhere may come to it.
    if (inside.from.empty()) inside.from = inside.within;
    return head_of(velocity * rate, inside) + (rate > 0 ? dot(velocity, velocity) / 2 : 0);
  }

  template <class R>
  struct Step {
    Vec3<R> point, u;
    R inverse_radius2, rate, speed;  ///< 1/m^2, -rate dt, m/s

    static Step of(const Brush& f, double dt) {
      const auto u = static_cast<Vec3<R>>(f.velocity);
      return {static_cast<Vec3<R>>(f.point), u, static_cast<R>(1 / (f.radius * f.radius)), static_cast<R>(-f.rate * dt),
              sqrt(dot(u, u))};
    }
    /// The part of v - u that a step leaves.
    DM_FN R keep(const Vec3<R>& x) const {
      const Vec3<R> d = x - point;
      const R w = max(R(1) - dot(d, d) * inverse_radius2, R(0));
      return exp(rate * w * w);
    }
    DM_FN Vec3<R> operator()(const Vec3<R>& v, const Vec3<R>& x) const { return u + (v - u) * keep(x); }
    DM_FN R fastest(const R& s, const Vec3<R>& x) const { return speed > s ? speed + (s - speed) * keep(x) : s; }
  };
};

}  // namespace dreampm
