// The cost of edits of a running simulation: gravity, a parameter, a wall, a crate.
#pragma once
#include <cstdint>
#include <vector>

#include "bench/bench.h"

namespace dreampm {

struct EditBenchOptions {
  std::int64_t particles = 100000;  ///< about how many
  int faces = 100000;               ///< about how many, of the mesh beside them
  int threads = 1;
  BenchBackend backend;
  int rounds = 40;  ///< of which the median counts
};

/// A pool of water about a mesh, and a crate that floats. A row for each edit [ms]: the call alone,
/// without the step after it; then what forming the grid anew takes, which the next step does once
/// for all edits before it.
std::vector<BenchRow> bench_edits(const EditBenchOptions& options);

}  // namespace dreampm
