// Embree 3 and 4 under one name: what they call differently.
#pragma once
#include "dreampm/base/error.h"
#include "dreampm/render/intersect.h"
#if DM_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace dreampm::trace {

/// A device and a scene, with their end.
struct EmbreeScene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~EmbreeScene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  /// Throws RunError if Embree has noted an error since the last call.
  void check(const char* doing) const {
    const RTCError e = rtcGetDeviceError(device);
    if (e == RTC_ERROR_OUT_OF_MEMORY) fail_run("Embree ran out of memory while {}", doing);
    if (e != RTC_ERROR_NONE) fail_run("Embree failed with error {} while {}", static_cast<int>(e), doing);
  }
};

#if DM_EMBREE == 3
using RayContext = RTCIntersectContext;
#else
using RayContext = RTCRayQueryContext;
#endif
/// What filters get to know about a ray.
struct GrainContext {
  RayContext base;
  PassedGrains* passed;  ///< or null: grains are hit
};

/// The first hit of a ray with a scene.
inline void first_hit(RTCScene scene, RTCRayHit& ray, PassedGrains* passed) {
  GrainContext context{{}, passed};
#if DM_EMBREE == 3
  rtcInitIntersectContext(&context.base);
  rtcIntersect1(scene, &context.base, &ray);
#else
  rtcInitRayQueryContext(&context.base);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context.base;
  rtcIntersect1(scene, &ray, &arguments);
#endif
}

/// Of grains: notes them and lets the ray pass, as long as there is room.
inline void pass_grain(const RTCFilterFunctionNArguments* a) {
  PassedGrains* const passed = reinterpret_cast<GrainContext*>(a->context)->passed;
  if (passed == nullptr || passed->count == passed->met.size()) return;
  const unsigned grain = RTCHitN_primID(a->hit, a->N, 0);
  const float opacity = static_cast<const float*>(a->geometryUserPtr)[grain];
  if (passed->lot != 0) {
    if (unit_float(hash32(passed->lot ^ hash32(grain))) >= opacity) a->valid[0] = 0;
    return;
  }
  a->valid[0] = 0;
  // Embree may come to one grain more than once.
  for (std::size_t i = 0; i < passed->count; ++i)
    if (passed->met[i].grain == grain) return;
  passed->met[passed->count++] = {RTCRayN_tfar(a->ray, a->N, 0), 1 - opacity, grain};
}

}  // namespace dreampm::trace
