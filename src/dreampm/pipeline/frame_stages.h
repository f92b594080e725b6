// The stages between the simulation and the film, in their order: each works on frames one by one.
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
};

/// A stage is a row here: `make` runs all of them, a task of a farm those of its chunk.
std::span<const FrameStage> frame_stages();

}  // namespace dreampm
