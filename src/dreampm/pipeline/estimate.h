// What the stages after the simulation will take, before they start.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"

namespace dreampm {

/// Thread-seconds that a step takes for a particle, where none is there to be measured. Measured on
/// the preview of flow-in-the-dragon.
inline constexpr double simulate_per_particle = 7.5e-7;

struct StageEstimate {
  double surface_seconds = 0, render_seconds = 0, video_seconds = 0;
  std::uint64_t disk_bytes = 0;    ///< of meshes, pictures and film; particles and checkpoints come on top
  std::uint64_t memory_bytes = 0;  ///< of drawing, or of foam, on top of what the simulation took
};

/// What the foam stage takes at most.
struct FoamEstimate {
  std::uint64_t most = 0;          ///< grains at once
  std::uint64_t memory_bytes = 0;  ///< with the matter of two frames
  std::uint64_t frame_bytes = 0;   ///< of a file
};
/// `particles`: of the matter, at most.
FoamEstimate estimate_foam(const model::Foam& foam, std::uint64_t particles);

/// From rates measured once on a desktop core, for this machine's number of threads: right within a
/// factor of about two.
StageEstimate estimate_stages(const model::Scene& scene, std::size_t particles);

/// Bytes of one particle in a particle file.
std::size_t particle_file_bytes(const model::Scene& scene);

/// The newest checkpoints of a run that its folder keeps.
inline constexpr int checkpoints_kept = 2;
/// Bytes that all stages write.
std::uint64_t disk_estimate(const model::Scene& scene, std::size_t particles);
/// What is wrong with the room on the file system of a folder that is there; empty if nothing.
std::string disk_shortage(std::uint64_t bytes, const std::filesystem::path& folder);

/// What surface and render would refuse once the simulation is done, in words.
std::vector<std::string> refused_later(const model::Scene& scene);

}  // namespace dreampm
