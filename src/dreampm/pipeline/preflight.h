// What a run will need, and what stands in its way, before it starts.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"

namespace dreampm {

/// What a run will need, before it starts.
struct Preflight {
  std::size_t particles = 0;  ///< at the start,
  std::uint64_t inflow = 0;   ///< and those that emitters give at most
  double dx = 0, dt = 0;      ///< m, s: of the first steps, or, where matter comes in, of later ones
  std::string limiter;
  int stages = 0;  ///< of viscosity, in each of them
  double substeps_per_frame = 0;
  double solid_steps = 0;  ///< of a projection: explicit ones of matter in the liquid, in each of them
  std::uint64_t memory_bytes = 0, disk_bytes = 0;  ///< of all stages; memory at most
  double simulate_seconds = 0;
  std::vector<std::string> warnings;  ///< overlapping bodies with their volume, and the like
  std::vector<std::string> notes;     ///< derived bulk moduli, rounded walls
};
/// `file` names the scene in messages. Throws as `simulate` does for a scene that cannot start, and
/// for an output folder that cannot be made.
Preflight preflight(const model::Scene& scene, const std::string& file);

}  // namespace dreampm
