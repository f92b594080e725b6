// A world on disk, and back: the same bits.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "dreampm/base/error.h"
#include "dreampm/run/frame_sums.h"
#include "dreampm/run/probe_set.h"

namespace dreampm {

struct CheckpointInfo {
  std::string scene_hash, backend, isa;
  FrameSums sums;
  std::uint64_t particle_steps = 0;
  ProbeMemories probes;
  std::string precision = {};  ///< set by reading: float or double; empty of a file of an earlier version
  // Set by checkpoint_info alone: where the world in the file stands.
  int frame = 0;
  double time = 0;              ///< s
  std::uint64_t particles = 0;  ///< of all sets
};

template <class R>
void save_checkpoint(const std::filesystem::path& file, const World<R>& world, const CheckpointInfo& info);

/// Who wrote it and where it stands, without loading it.
CheckpointInfo checkpoint_info(const std::filesystem::path& file);

/// The file is whole, and its numbers are float where double is wanted, or the other way round.
class OtherPrecision : public InputError {
 public:
  using InputError::InputError;
};

/// Fills `world`, which was assembled from the same scene. Throws OtherPrecision, and InputError
/// for a file of another scene or version or one that is damaged.
template <class R>
CheckpointInfo load_checkpoint(const std::filesystem::path& file, const std::string& scene_hash, World<R>& world);

}  // namespace dreampm
