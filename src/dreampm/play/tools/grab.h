// A drag that takes hold of matter, or of a rigid body, by the verbs of the tool grab.
#pragma once
#include "dreampm/play/tools/gesture.h"

namespace dreampm::play {

void begin_pick(Gesture& gesture);
void update_pick(Gesture& gesture);
void end_pick(Gesture& gesture);

}  // namespace dreampm::play
