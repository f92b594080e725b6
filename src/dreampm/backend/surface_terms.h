// The terms of contact at points of colliders' surfaces (backend/surface_contact.h says what is
// solved): of one point and of one node. Compilers of device code read it too.
#pragma once
#include "dreampm/backend/node_terms.h"
#include "dreampm/physics/collider_contact.h"

namespace dreampm {

template <class R>
DM_FN R mass_or_none(const Node<R>& node) {
  return has_mass(node) ? node.m : R(0);
}

/// A point's weight over the node's mass, bounded from below [1/kg], 0 without mass;
/// `open_fraction`: of the node's kernel, outside the colliders. At a plane surface of much matter
/// the mass at the point is half of that of a node whose kernel is full.
template <class R>
DM_FN R bounded_inverse_mass(const R& w, const R& mass, const R& open_fraction, const R& at_point) {
  const R least = at_point * max(static_cast<R>(2 * ColliderContact::least_fill) * open_fraction,
                                 static_cast<R>(ColliderContact::least_share) * w);
  return mass > R(0) ? w / max(mass, least) : R(0);
}

/// The impulse per velocity of a point [kg]. `held_weight`: the sum of its weights at nodes with
/// matter; `row`: of its row of sum_i w_is w_it / m_i. A point that does not act, but limits
/// another, only needs to be positive.
template <class R>
DM_FN R effective_mass_of(const R& held_weight, const R& row, bool acts) {
  const R part =
      (held_weight - R(ColliderContact::held_from)) * R(1 / (ColliderContact::held_whole - ColliderContact::held_from));
  if (!(part > R(0) && (row > R(0) || !acts))) return R(0);
  return acts ? min(part, R(1)) / row : part;
}

/// The impulse of a point after a step of the descent. `speed`: of matter along the normal, beside
/// that of the surface; `approach`: at which it may still come nearer [m/s]; `least`: no less than
/// this where matter can separate.
template <class R>
DM_FN R descended(const R& extrapolated, const R& speed, const R& effective_mass, const R& approach, bool separates,
                  const R& least) {
  R now = extrapolated - speed * effective_mass;
  if (now > R(0)) now = max(now - approach * effective_mass, R(0));
  return separates ? max(now, least) : now;
}
/// The least impulse of a point where matter can separate: that of a surface that holds it by
/// `sticky` [Pa s] or not at all.
template <class R>
DM_FN R least_impulse(double sticky, double dx, const R& per_dt) {
  return sticky > 0 ? static_cast<R>(-sticky * dx * dx * dx) / per_dt : R(0);
}
/// At an edge: at most the impulse of the point that limits it, and the weight of the matter
/// between. A kernel at a plane surface is half full.
template <class R>
DM_FN R limited_at_edge(const R& now, const R& limiter, const Vec3<R>& from_edge, const R& mass,
                        const Vec3<R>& gravity_kick) {
  const R weight = max(R(0), -dot(gravity_kick, from_edge)) * 2 * mass, most = abs(limiter) + weight;
  return min(max(now, -most), most);
}
/// The momentum of the descent after step `step`; the last one stays where it is.
template <class R>
DM_FN R momentum_of_descent(int step, int last) {
  return step < last ? R(step) / R(step + 3) : R(0);
}

/// A node's velocity after Coulomb friction of at most `most` [m/s]. `facing`: along the normal.
template <class R>
DM_FN Vec3<R> after_friction(const Vec3<R>& v, const Vec3<R>& surface, const Vec3<R>& facing, const R& most) {
  const R length = sqrt(dot(facing, facing));
  if (!(most > R(0) && length > R(0))) return v;
  return apply_coulomb_friction(v - surface, facing * (R(1) / length), most) + surface;
}
/// No faster than the fastest node was before contact.
template <class R>
DM_FN Vec3<R> clamped_speed(const Vec3<R>& v, const Vec3<R>& surface, const R& max_speed2) {
  const Vec3<R> relative = v - surface;
  const R speed2 = dot(relative, relative);
  return speed2 > max_speed2 ? relative * sqrt(max_speed2 / speed2) + surface : v;
}
/// The velocity at which a contact impulse works. A wall that stands still does work by friction
/// alone: of what is left along normals, putting particles back undoes as much.
template <class R>
DM_FN Vec3<R> works_at(const Vec3<R>& after, const Vec3<R>& surface, const Vec3<R>& facing, bool frictional) {
  const Vec3<R> relative = after - surface;
  if (!frictional) return surface;
  return surface + (relative - facing * (dot(relative, facing) / max(dot(facing, facing), R(1e-30))));
}

}  // namespace dreampm
