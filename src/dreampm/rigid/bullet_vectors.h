// Between the vectors of this library and Bullet's.
#pragma once
#include <LinearMath/btTransform.h>

#include "dreampm/pose.h"

namespace dreampm {

inline btVector3 bullet(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline Vec3d from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion bullet(const Quaternion& q) { return {q.x, q.y, q.z, q.w}; }
inline btTransform bullet(const Pose& p) { return btTransform(bullet(p.rotation), bullet(p.position)); }

/// `a` after `b`.
inline Pose together(const Pose& a, const Pose& b) { return {a(b.position), a.rotation * b.rotation}; }
inline Pose inverse_of(const Pose& p) { return {p.rotation.inverse()(p.position * -1.0), p.rotation.inverse()}; }

}  // namespace dreampm
