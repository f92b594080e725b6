// The cost of the frames of a scene of water by the projection beside explicit steps.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "dreampm/model/scene.h"

namespace dreampm {

/// The cost of one solver, over all frames.
struct SolverCost {
  std::uint64_t steps = 0, particle_steps = 0;
  double cpu_seconds = 0;  ///< of steps alone: no files, sums of frames or hashes
};
struct SolversCost {
  std::uint64_t particles = 0;  ///< in the end
  SolverCost explicit_steps, projection;
};

/// Steps the scene to `frames` (at most its own), frame by frame in turns, so that what else the
/// machine does falls on both, on one thread. Both with jittered particles; the projection with its
/// usual steps and transfer, the explicit solver as the scene says. `each(frame, cost)` after every
/// frame of both. Throws InputError for a scene that the projection cannot do.
SolversCost bench_solvers(const model::Scene& scene, int frames,
                          const std::function<void(int, const SolversCost&)>& each = {});

}  // namespace dreampm
