// Embree 3 and 4 under one name: what they call differently.
#pragma once
#if DM_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace dreampm::trace {

/// The first hit of a ray with a scene.
inline void first_hit(RTCScene scene, RTCRayHit& ray) {
#if DM_EMBREE == 3
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
#else
  rtcIntersect1(scene, &ray);
#endif
}

}  // namespace dreampm::trace
