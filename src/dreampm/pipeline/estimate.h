// What the stages after the simulation will take, before they start.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dreampm/scene/description.h"

namespace dreampm {

/// Thread-seconds that a step takes for a particle, where none is there to be measured. Measured on
/// the preview of flow-in-the-dragon.
inline constexpr double simulate_per_particle = 7.5e-7;

struct StageEstimate {
  double surface_seconds = 0, render_seconds = 0, video_seconds = 0;
  std::uint64_t disk_bytes = 0;    ///< of meshes, pictures and film; particles and checkpoints come on top
  std::uint64_t memory_bytes = 0;  ///< of drawing, on top of what the simulation took
};

/// From rates measured once on a desktop core, for this machine's number of threads: right within a
/// factor of about two.
StageEstimate estimate_stages(const SceneDescription& scene, std::size_t particles);

/// Bytes of one particle in a particle file.
std::size_t particle_file_bytes(const scene::Output& output);

/// What surface and render would refuse once the simulation is done, in words.
std::vector<std::string> refused_later(const SceneDescription& scene);

}  // namespace dreampm
