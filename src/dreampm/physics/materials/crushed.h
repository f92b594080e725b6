// What holds elastic matter from being crushed to nothing. The Kirchhoff stress of fixed corotated
// and of this neo-Hookean goes to 0 where the stretches do. A grid cannot resolve a body smaller
// than a cell, so that no load stops it then and nothing drives it back. Below J = `crushed_ratio`
// they gain psi = K l^3/3, l = ln(crushed_ratio/J), with K = lambda + 2 mu: tau = -K l^2 I grows
// without bound as J goes to 0 (the growth condition of Ball 1976, Arch. Ration. Mech. Anal.
// 63:337). Of a logarithm a step sees little at once; its cube begins with no jump of the wave
// speed. Where J >= `crushed_ratio` nothing changes, not a bit.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/math/stretch.h"
#include "dreampm/physics/law.h"

namespace dreampm {

inline constexpr double crushed_ratio = 0.2;
/// Of l: beyond it the stress is constant, so that one flat particle does not stop all steps.
inline constexpr double most_crushed_log = 12;

template <class R>
struct Crushed {
  R pressure, energy, modulus;  ///< Pa: -tau; psi; what it adds to rho c^2
};

/// Of a volume ratio J, of negative ones as their mirror images; 0 above `crushed_ratio`.
/// `stiffness`: K above.
template <class R>
DM_FN Crushed<R> crushed(const R& j, const R& stiffness) {
  using S = Scalar<R>;
  const R l = max(log(R(S(crushed_ratio)) / max(abs(j), R(S(1e-30)))), R(S(0)));
  const R held = min(l, R(S(most_crushed_log))), pressure = stiffness * held * held;
  return {pressure, pressure * (l - held * R(S(2.0 / 3))), pressure + stiffness * (held + held)};
}

template <class R>
DM_FN auto is_crushed(const R& j) {
  return j < R(Scalar<R>(crushed_ratio));
}

/// Adds it to an answer where J is below `crushed_ratio`.
template <class R>
DM_FN void press_back(StressResponse<R>& r, const R& j, const R& stiffness, const R& inverse_density) {
  const auto is_crushed = j < R(Scalar<R>(crushed_ratio));
  if (!any(is_crushed)) [[likely]]
    return;
  const Crushed<R> c = crushed(j, stiffness);
  for (R* normal : {&r.tau.xx, &r.tau.yy, &r.tau.zz}) *normal = select(is_crushed, *normal - c.pressure, *normal);
  r.energy = r.energy + c.energy;
  r.sound_speed =
      select(is_crushed, sqrt(mul_add(r.sound_speed, r.sound_speed, c.modulus * inverse_density)), r.sound_speed);
}

/// A step that was too long may turn matter inside out, and no later step brings that back: it
/// multiplies F by what is near 1, so that det F keeps its sign. What isotropic laws feel is F F^T,
/// which is the same for the mirror image, U diag(|s|) V^T: F becomes that. Gives the energy that
/// this frees; `energy()`: of d.s as it is, without that of crushed matter.
template <class R, class Energy>
DM_FN R turn_outside_out(Mat3<R>& f, Stretches<R>& d, const Energy& energy) {
  const R zero(Scalar<R>(0));
  const auto inverted = d.product() < zero;
  if (!any(inverted)) [[likely]]
    return zero;
  const R before = energy();
  for (int i = 0; i < 3; ++i) d.s[i] = select(inverted, abs(d.s[i]), d.s[i]);
  const Mat3<R> kept = d.with(d.s);
  for (int k = 0; k < 9; ++k) f.m[k] = select(inverted, kept.m[k], f.m[k]);
  return select(inverted, before - energy(), zero);
}

}  // namespace dreampm
