// A drag that takes hold of matter, or of a rigid body, by the verbs of the tool grab.
#pragma once
#include "dreampm/play/tools/gesture.h"

namespace dreampm::play {

inline void begin_pick(Gesture& g) { g.post("grab", {g.hit->at.x, g.hit->at.y, g.hit->at.z, g.settings.radius}); }
inline void update_pick(Gesture& g) {
  const Vec3d to = clamped(g.on_drag_plane(), g.domain, g.spacing);
  g.post("pull", {to.x, to.y, to.z});
}
inline void end_pick(Gesture& g) { g.post("release"); }

}  // namespace dreampm::play
