#include "dreampm/pipeline/make.h"

#include <optional>

#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/changes.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/foam_stage.h"
#include "dreampm/pipeline/models.h"
#include "dreampm/pipeline/render_stage.h"
#include "dreampm/pipeline/run_folder.h"
#include "dreampm/pipeline/surface_stage.h"
#include "dreampm/pipeline/video_stage.h"
#include "dreampm/scene/emit.h"
#include "dreampm/video/encode.h"

namespace dreampm {
namespace fs = std::filesystem;
namespace {

/// What an earlier call left, if it can be read.
std::optional<RunRecord> earlier_record(const fs::path& folder) {
  if (!fs::exists(folder / "run.json")) return std::nullopt;
  try {
    return RunRecord::load(folder / "run.json");
  } catch (const InputError& e) {
    warn("{}; the run starts again", e.what());
    return std::nullopt;
  }
}

bool all_frames_there(const RunRecord& record, const model::Scene& scene, const fs::path& folder) {
  if (record.frames.empty() || record.frames.back().frame < scene.time.frames) return false;
  for (int f = record.frames.front().frame; f <= scene.time.frames; ++f)
    if (!fs::exists(folder / "particles" / numbered("particles", f, ".ply"))) return false;
  return true;
}

/// Simulates what is missing. Returns whether anything was.
bool simulate_rest(const model::Scene& scene, const SceneSource& source, const MakeOptions& options,
                   const std::shared_ptr<RunLock>& lock) {
  const std::optional<RunRecord> record = earlier_record(options.folder);
  bool resume = false;
  if (record) {
    const auto stage = record->stages.find("simulate");
    const bool same = stage != record->stages.end() && stage->second.settings_hash &&
                      *stage->second.settings_hash == scene::scene_hash(scene, scene::Part::particles) &&
                      record->backend == SimulateOptions().backend &&
                      (options.isa == "auto" || options.isa == record->machine.isa);
    const char* const changed = record->backend != SimulateOptions().backend                  ? "the backend"
                                : options.isa != "auto" && options.isa != record->machine.isa ? "the instruction set"
                                                                                              : "the scene";
    const bool whole = all_frames_there(*record, scene, options.folder);
    if (same && whole) return false;
    if (!same) info("simulate: {} changed: starts again", changed);
    // Frames that are gone lie before the checkpoint: only a new start brings them back.
    const bool gone = !whole && !record->frames.empty() && record->frames.back().frame >= scene.time.frames;
    if (same && gone) info("simulate: particle files are gone: starts again");
    resume = same && !gone;
  }
  SimulateOptions simulation;
  simulation.folder = options.folder;
  simulation.threads = options.threads;
  simulation.isa = options.isa;
  simulation.resume = resume;
  simulation.lock = lock;
  simulate(scene, source, simulation);
  return true;
}

bool make_stages(const model::Scene& scene, const SceneSource& source, const MakeOptions& options) {
  std::string refused;
  for (const std::string& e : refused_later(scene))
    refused += fmt::format("{}{}: error: {}", refused.empty() ? "" : "\n", source.path, e);
  if (!refused.empty()) throw InputError(refused);
  check_encoder();
  const auto lock = std::make_shared<RunLock>(options.folder);
  const model::Scene kept = with_kept_models(scene);
  const std::string resolved = scene::emit_scene(kept);
  const fs::path scene_file = options.folder / "scene.yaml";
  if (fs::exists(scene_file))
    for (const std::string& change : changed_keys(read_file(scene_file), resolved)) info("changed: {}", change);
  bool any = simulate_rest(scene, source, options, lock);
  write_run_scene(scene, options.folder);

  RunFolder run{options.folder, located_in(kept, options.folder), RunRecord::load(options.folder / "run.json"), lock};
  any |= foam_stage(run).made > 0;
  any |= surface_stage(run).made > 0;
  any |= render_stage(run).made > 0;
  any |= video_stage(run).made > 0;
  return any;
}

}  // namespace

bool make(const model::Scene& scene, const SceneSource& source, const MakeOptions& options) {
  const ThreadLimit threads(options.threads);
  try {
    return make_stages(scene, source, options);
  } catch (const Interrupted&) {
    throw Interrupted("interrupted; what is done is kept: type the same command again to go on");
  }
}

}  // namespace dreampm
