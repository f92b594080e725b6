// Contact of a grid node with a wall or collider, from numbers alone.
#pragma once
#include "dreampm/math/explog.h"
#include "dreampm/math/scalar.h"
#include "dreampm/math/vec.h"
#include "dreampm/walls.h"

namespace dreampm {

/// Coulomb friction along a surface of normal `n`: takes up to `most` > 0 [m/s] of the tangential
/// velocity `v`.
template <class R>
DM_FN Vec3<R> apply_coulomb_friction(const Vec3<R>& v, const Vec3<R>& n, const R& most) {
  using S = Scalar<R>;
  const Vec3<R> out = n * dot(v, n), along = v - out;
  const R speed = sqrt(dot(along, along));
  return select(speed <= most, out, out + along * (R(S(1)) - most / speed));
}

/// The velocity after contact. `v`: relative to the wall [m/s]; `n`: unit normal out of the wall;
/// Coulomb friction reduces the tangential velocity by at most `friction` times the normal velocity
/// that was taken away (Stomakhin et al. 2013, section 8).
template <class R>
DM_FN Vec3<R> contact(const Vec3<R>& v, const Vec3<R>& n, WallType type, Scalar<R> friction) {
  using S = Scalar<R>;
  const R zero(S(0));
  if (type == WallType::open) return v;
  if (type == WallType::stick) return {zero, zero, zero};
  const R vn = dot(v, n);
  Vec3<R> after = v - n * vn;
  if (friction > S(0)) after = select(vn < zero, apply_coulomb_friction(after, n, -vn * R(friction)), after);
  return type == WallType::separate ? select(vn >= zero, v, after) : after;
}

/// 1/u+^2 of a smooth wall: its shear stress over rho u^2, where a liquid moves along it at u in a
/// distance y; `re` = u y/nu > 0. From viscous flow (1/re) to the logarithmic law, in one formula
/// (Spalding 1961, J. Appl. Mech. 28:455):
///   y+ = u+ + e^(-kappa B) (e^a - 1 - a - a^2/2 - a^3/6), a = kappa u+;  u+ y+ = re.
template <class R>
DM_FN R wall_shear(const R& re) {
  using S = Scalar<R>;
  constexpr double kappa = 0.41, b = 5.0;  // Coles and Hirst 1968
  const R one(S(1)), half(S(0.5)), sixth(S(1.0 / 6)), damped(S(__builtin_exp(-kappa * b)));
  // The product grows with u+ and is convex: from above Newton's steps come down without fail.
  // Viscous flow bounds u+, and so does the logarithm.
  R u = min(sqrt(re), R(S(2.5)) * log(one + re) + R(S(6)));
#pragma GCC unroll 1
  for (int k = 0; k < 12; ++k) {
    const R a = u * R(S(kappa)), e = exp(a), series = one + a * (one + a * (half + a * sixth));
    const R y = u + damped * (e - series), slope = one + damped * R(S(kappa)) * (e - one - a * (one + a * half));
    u = u - (u * y - re) / (y + u * slope);
  }
  return one / (u * u);
}

/// Mean distance from the wall of the matter that a node on it stands for [cells]: the mean of |x|
/// under the quadratic spline.
inline constexpr double wall_node_height = 13.0 / 32;

// Viscous contact is given as a drag: a rate times dt [1]. Taken implicitly, x/(1 + x) of the
// velocity is lost.

/// Returns the drag on a liquid at a node on a smooth wall, by its boundary layer: the node stands
/// for the half cell beside the wall, which moves at `speed` > 0 [m/s] in its middle. `viscosity` >
/// 0 [m^2/s], `per_step` = dt/dx [s/m].
template <class R>
DM_FN R skin_drag(const R& speed, const R& viscosity, const R& dx, const R& per_step) {
  using S = Scalar<R>;
  return R(S(2)) * wall_shear(speed * dx * R(S(wall_node_height)) / viscosity) * speed * per_step;
}
/// Returns the drag on the slip between a liquid and a solid that share a node, by viscosity over
/// one cell: `diffusion` = dt nu/dx^2 of the liquid; masses [kg].
template <class R>
DM_FN R slip_drag(const R& diffusion, const R& m_liquid, const R& m_solid) {
  return diffusion * (m_liquid + m_solid) / m_solid;
}
/// The skin's drag in viscous flow over dt nu/dx^2. No viscous contact has more than this among the
/// forces of a stage (physics/dt.h).
inline constexpr double stage_drag = 2 / wall_node_height;

/// Takes `change` [m/s] off the velocity between a liquid and a solid at a node; momentum is kept.
template <class R>
DM_FN void exchange_velocity(const Vec3<R>& change, Vec3<R>& v_liquid, const R& m_liquid, Vec3<R>& v_solid,
                             const R& m_solid) {
  const R total = m_liquid + m_solid;
  v_liquid = v_liquid - change * (m_solid / total);
  v_solid = v_solid + change * (m_liquid / total);
}

/// Contact of a solid and a liquid that share a node. `v_liquid`, `v_solid` [m/s]; masses [kg];
/// `n`: unit normal out of the solid, or zero where there is none: then both move as one. They may
/// part, but not enter each other (an inelastic hit; Bardenhagen et al. 2000, eq. 9); along the
/// surface they slide, against `drag` as in slip_drag, taken implicitly. Momentum is kept.
template <class R>
DM_FN void two_field_contact(Vec3<R>& v_liquid, const R& m_liquid, Vec3<R>& v_solid, const R& m_solid, const Vec3<R>& n,
                             const R& drag) {
  const R zero(0), one(1);
  const Vec3<R> slip = v_liquid - v_solid;
  const R along = dot(slip, n);
  Vec3<R> change = slip;
  if (dot(n, n) > zero) change = (slip - n * along) * (drag / (one + drag)) + n * (along < zero ? along : zero);
  exchange_velocity(change, v_liquid, m_liquid, v_solid, m_solid);
}

}  // namespace dreampm
