// The foam stage: spray, foam, bubbles and dust of a run's frames, from its particle files alone.
#pragma once
#include "dreampm/pipeline/foam_files.h"
#include "dreampm/pipeline/stage.h"

namespace dreampm {

/// foam/foam_000001.ply
std::filesystem::path foam_file(const RunFolder& run, int frame);
/// What a frame's foam depends on, the frames before it included; `run` must outlive it. Empty for
/// a scene without foam.
std::function<Identity(int frame)> foam_identity(const RunFolder& run);

/// Why one of the frames has no foam that is up to date, and what makes it; empty if all have, and
/// for a scene without foam.
std::string no_foam(const RunFolder& run, const std::vector<int>& frames);

/// What was emitted, where and why, and what became of it: lines for a person.
std::vector<std::string> foam_lines(const RunRecord& record);

/// Makes the foam that is not up to date. What is to be found is found of all frames first. Each
/// frame is made of the foam of the one before, so frames may be made one at a time in their order.
/// What was emitted goes into run.json. Throws InputError for a particle file without velocities,
/// and for a frame whose predecessor has no foam that is up to date.
StageResult foam_stage(RunFolder& run, const FrameRange& frames = {});

}  // namespace dreampm
