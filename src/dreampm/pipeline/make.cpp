#include "dreampm/pipeline/make.h"

#include <functional>
#include <optional>

#include "dreampm/backend/registry.h"
#include "dreampm/base/error.h"
#include "dreampm/base/file.h"
#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/numbered.h"
#include "dreampm/pipeline/changes.h"
#include "dreampm/pipeline/chunk.h"
#include "dreampm/pipeline/estimate.h"
#include "dreampm/pipeline/frame_stages.h"
#include "dreampm/pipeline/models.h"
#include "dreampm/pipeline/video_stage.h"
#include "dreampm/render/denoise.h"
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
    const bool other_backend = !options.backend.empty() && options.backend != record->backend,
               other_isa = options.isa != "auto" && options.isa != record->machine.isa;
    const bool same = stage != record->stages.end() && stage->second.settings_hash &&
                      *stage->second.settings_hash == scene::scene_hash(scene, scene::Part::particles) &&
                      !other_backend && !other_isa;
    const char* const changed = other_backend ? "the backend" : other_isa ? "the instruction set" : "the scene";
    const bool whole = all_frames_there(*record, scene, options.folder);
    if (same && whole) return false;
    if (!same) info("simulate: {} changed: starts again", changed);
    // Frames that are gone lie before the checkpoint: only a new start brings them back.
    const bool gone = !whole && !record->frames.empty() && record->frames.back().frame >= scene.time.frames;
    if (same && gone) info("simulate: particle files are gone: starts again");
    resume = same && !gone;
    if (const std::string_view usual = backends().front().name;
        !resume && options.backend.empty() && record->backend != usual)
      info("simulate: by the backend {}; the run before was by {}", usual, record->backend);
  }
  SimulateOptions simulation;
  simulation.folder = options.folder;
  simulation.threads = options.threads;
  simulation.backend = options.backend;
  simulation.isa = options.isa;
  simulation.resume = resume;
  simulation.lock = lock;
  simulate(scene, source, simulation);
  return true;
}

void check_scene(const model::Scene& scene, const SceneSource& source) {
  std::string refused;
  for (const std::string& e : refused_later(scene))
    refused += fmt::format("{}{}: error: {}", refused.empty() ? "" : "\n", source.path, e);
  if (!refused.empty()) throw InputError(refused);
}

/// What is simulated, or was before. `any`: whether there was something to do.
RunFolder simulated(const model::Scene& scene, const SceneSource& source, const MakeOptions& options, bool& any) {
  const auto lock = std::make_shared<RunLock>(options.folder);
  if (std::optional<RunRecord> earlier = earlier_record(options.folder)) fold_chunks(options.folder, *earlier);
  const model::Scene kept = with_kept_models(scene);
  const std::string resolved = scene::write_scene(kept);
  const fs::path scene_file = options.folder / "scene.yaml";
  if (fs::exists(scene_file))
    for (const std::string& change : changed_keys(read_file(scene_file), resolved)) info("changed: {}", change);
  any = simulate_rest(scene, source, options, lock);
  write_run_scene(scene, options.folder);
  RunFolder run{options.folder, located_in(kept, options.folder), RunRecord::load(options.folder / "run.json"), lock};
  fold_chunks(options.folder, run.record);
  return run;
}

bool make_stages(const model::Scene& scene, const SceneSource& source, const MakeOptions& options) {
  check_scene(scene, source);
  check_encoder();
  if (scene.render.denoise) check_denoiser();
  bool any = false;
  RunFolder run = simulated(scene, source, options, any);
  for (const FrameStage& stage : frame_stages()) any |= stage.make(run, {}).made > 0;
  any |= video_stage(run).made > 0;
  return any;
}

/// What was simulated must be this scene, or frames of two would mix.
void check_same_scene(const model::Scene& scene, const SceneSource& source, const fs::path& folder) {
  const fs::path file = folder / "scene.yaml";
  if (!fs::exists(file) || !fs::exists(folder / "run.json"))
    fail_input("{}: nothing is simulated there; dreampm make {} --only simulate --out {} does it", folder.string(),
               source.path, folder.string());
  std::vector<std::string> changes = changed_keys(read_file(file), scene::write_scene(with_kept_models(scene)));
  std::erase_if(changes, [](const std::string& c) { return c.starts_with("output.folder:"); });
  if (!changes.empty())
    fail_input("{}: {} is another scene than the one there ({}); dreampm make --only simulate comes first",
               folder.string(), source.path, changes[0]);
}

/// Calls `work`, with threads, and an end that says how to go on.
bool interruptible(const MakeOptions& options, const std::function<bool()>& work) {
  const ThreadLimit threads(options.threads);
  try {
    return work();
  } catch (const Interrupted&) {
    throw Interrupted("interrupted; what is done is kept: type the same command again to go on");
  }
}

}  // namespace

bool make(const model::Scene& scene, const SceneSource& source, const MakeOptions& options) {
  return interruptible(options, [&] { return make_stages(scene, source, options); });
}

bool make_simulation(const model::Scene& scene, const SceneSource& source, const MakeOptions& options) {
  check_scene(scene, source);
  return interruptible(options, [&] {
    bool any = false;
    RunFolder run = simulated(scene, source, options, any);
    for (const FrameStage& stage : frame_stages())
      if (stage.in_order) any |= stage.make(run, {}).made > 0;
    return any;
  });
}

bool make_frames(const model::Scene& scene, const SceneSource& source, const MakeOptions& options,
                 const FrameRange& frames) {
  check_same_scene(scene, source, options.folder);
  return interruptible(options, [&] {
    RunFolder run = open_chunk(options.folder, frames);
    bool any = false;
    for (const FrameStage& stage : frame_stages())
      if (!stage.in_order) any |= stage.make(run, frames).made > 0;
    return any;
  });
}

bool make_film(const model::Scene& scene, const SceneSource& source, const MakeOptions& options) {
  check_encoder();
  check_same_scene(scene, source, options.folder);
  return interruptible(options, [&] {
    RunFolder run = open_run(options.folder, Access::write);
    run.frame_record(scene.time.frames);  // throws where the simulation has not come so far
    for (const FrameStage& stage : frame_stages())
      if (const std::string why = stage.missing(run, run.frames()); !why.empty()) fail_input("{}", why);
    bool any = false;
    for (const FrameStage& stage : frame_stages()) any |= stage.make(run, {}).made > 0;  // what else is there goes
    return video_stage(run).made > 0 || any;
  });
}

}  // namespace dreampm
