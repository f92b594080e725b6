// The stages between the simulation and the film, in their order: each works on frames one by one.
// Frames of most stages can be made beside each other, by as many tasks of a farm as there are.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dreampm/pipeline/stage.h"

namespace dreampm {

struct FrameStage {
  std::string_view name;
  /// Makes what is not up to date of these frames.
  StageResult (*make)(RunFolder& run, const FrameRange& frames);
  /// Why one of the frames is not up to date; empty if all are.
  std::string (*missing)(const RunFolder& run, const std::vector<int>& frames);
  /// Whether a frame is made of the one before: then the task that simulates makes all of them.
  bool in_order = false;
};

/// A stage is a row here: `make` runs all of them, a task of a farm those of its chunk. One whose
/// frames follow from each other stands before those that do not.
std::span<const FrameStage> frame_stages();

}  // namespace dreampm
