// Contact of a grid node with a wall or collider, from numbers alone.
#pragma once
#include <cstdint>

#include "dreampm/math/scalar.h"
#include "dreampm/math/vec.h"

namespace dreampm {

/// open: no wall; separate: may leave, must not enter; slip: neither enters nor leaves; stick: moves with the wall.
enum class WallType : std::uint8_t { separate, slip, stick, open };

/// The velocity after contact. `v`: relative to the wall [m/s]; `n`: unit normal out of the wall; Coulomb friction
/// reduces the tangential velocity by at most `friction` times the normal velocity that was taken away (Stomakhin et
/// al. 2013, section 8).
template <class R>
DM_FN Vec3<R> contact(const Vec3<R>& v, const Vec3<R>& n, WallType type, const R& friction) {
  const R zero(0), one(1);
  if (type == WallType::open) return v;
  if (type == WallType::stick) return {zero, zero, zero};
  const R vn = dot(v, n);
  if (type == WallType::separate && vn >= zero) return v;
  const Vec3<R> tangential = v - n * vn;
  if (!(friction > zero)) return tangential;
  const R pressed = vn < zero ? -vn : zero;
  const R speed = sqrt(dot(tangential, tangential));
  if (speed <= friction * pressed) return {zero, zero, zero};
  return tangential * (one - friction * pressed / speed);
}

/// What a solid and a liquid do to each other where they share a node.
/// `v_liquid`, `v_solid` [m/s]; masses [kg]; `n`: unit normal out of the solid, or zero where there is none: then both
/// move as one. They may part, but not enter each other (an inelastic hit; Bardenhagen et al. 2000, eq. 9); along the
/// surface they slide, coupled only by viscosity over one cell: `diffusion` = dt nu/dx^2 of the liquid, taken
/// implicitly. Momentum is kept.
template <class R>
DM_FN void meet(Vec3<R>& v_liquid, const R& m_liquid, Vec3<R>& v_solid, const R& m_solid, const Vec3<R>& n,
                const R& diffusion) {
  const R zero(0), one(1);
  const Vec3<R> slip = v_liquid - v_solid;
  const R along = dot(slip, n), total = m_liquid + m_solid;
  const R shear = diffusion * total / m_solid;
  Vec3<R> lost = slip;
  if (dot(n, n) > zero) lost = (slip - n * along) * (shear / (one + shear)) + n * (along < zero ? along : zero);
  v_liquid = v_liquid - lost * (m_solid / total);
  v_solid = v_solid + lost * (m_liquid / total);
}

}  // namespace dreampm
