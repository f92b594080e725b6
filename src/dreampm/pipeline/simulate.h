// The simulate stage: a scene becomes particle files, a ledger, checkpoints and run.json in the
// run's folder.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/model/scene.h"
#include "dreampm/pipeline/run_lock.h"
#include "dreampm/pipeline/run_record_file.h"

namespace dreampm {

struct SimulateOptions {
  std::filesystem::path folder;     ///< of the run
  std::optional<int> frames;        ///< stop after this frame (the scene's own number if absent)
  int threads = 0;                  ///< 0: all cores
  std::string backend{};            ///< of backend/registry.h; empty: of what it goes on from, else the default
  std::string isa = "auto";         ///< instruction set; auto: of what it goes on from, else the widest
  bool strict = false;              ///< stop where the ledger does not close
  bool resume = false;              ///< go on from the newest usable checkpoint; false: start again
  bool overwrite = true;            ///< without resume: whether frames of an earlier run may be replaced
  std::shared_ptr<RunLock> lock{};  ///< on the folder, if the caller holds it; else it is taken
};

struct SimulateResult {
  int frames_done = 0;  ///< frames in the folder now
  int first_frame = 1;  ///< first frame that this call wrote
};

/// Runs the scene. Writes scene.yaml, models/, run.json (stage "simulate"), ledger.csv, particles/
/// and checkpoint/. Throws InputError for a scene that cannot start (a body outside the walls, no
/// memory for it, a checkpoint of another scene), for a folder that another process works in, and,
/// unless it may overwrite, for one with a run that is whole or can go on; a folder that was not
/// there is not there then. LedgerBreach of a strict run, Interrupted after saving when asked to
/// stop, RunError on a numerical or disk failure (the last good state stays). A run that goes on by
/// another backend or instruction set than before is the same to rounding, and its record says so;
/// InputError where that computes in another precision.
SimulateResult simulate(const model::Scene& scene, const SceneSource& source, const SimulateOptions& options);

}  // namespace dreampm
