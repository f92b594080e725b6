// The cost of a frame's files and sums beside its steps.
#pragma once
#include <string>

#include "bench/bench.h"
#include "bench/course.h"

namespace dreampm {

/// Seconds of one step, and of all that the end of a frame adds: a pass that stores velocities, the
/// particle file, the ledger's row, the hash and a few probes. Files go to a temporary folder.
struct FrameCost {
  double step = 0, output = 0;
};
FrameCost frame_cost(const Course& course, const BenchBackend& choice, int tries);

/// The share of a frame that these take where it has as many steps as one of the dragon at full
/// resolution, with the threads that may be used. `isa`: as rows name it.
BenchRow frame_row(const Course& course, const BenchBackend& choice, const std::string& isa);

}  // namespace dreampm
