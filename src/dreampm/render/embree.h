// Embree 3 and 4 under one name: what they call differently.
#pragma once
#include "dreampm/base/error.h"
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
