// The cost of wrapping particles in a mesh, stage by stage.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "bench/bench.h"

namespace dreampm {

struct SurfaceBenchOptions {
  std::int64_t particles = 1048576;  ///< about how many, 1000 or more
  double voxel = 0.5;                ///< spacings
  int threads = 2;
  int rounds = 5;               ///< of which the median counts
  bool solids = false;          ///< a pillar and a ball stand in the water
  std::filesystem::path write;  ///< writes the particles there as PLY, for other programs; empty: does not
};

/// Waves in a basin with a crown, a film that runs up a wall, and spray. A row for each stage [s],
/// and one for all of them. Throws InputError for an option out of range.
std::vector<BenchRow> bench_surface(const SurfaceBenchOptions& options);

}  // namespace dreampm
