// The cost of a frame's files and sums beside its steps.
#pragma once
#include <string>

#include "bench/course.h"

namespace dreampm {

/// Seconds of one step, and of all that the end of a frame adds: a pass that stores velocities, the
/// particle file, the ledger's row, the hash and a few probes. Files go to a temporary folder.
struct FrameCost {
  double step = 0, output = 0;
};
FrameCost frame_cost(const Course& course, const BackendChoice& choice, int tries);

}  // namespace dreampm
