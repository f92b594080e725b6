// What lies in a run's folder, and which of its frames are up to date.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/io/run_record.h"
#include "dreampm/model/scene.h"
#include "dreampm/pipeline/frame_table.h"
#include "dreampm/pipeline/run_lock.h"

namespace dreampm {

/// Frames `first` to `last`, both included; 0, 0: all.
struct FrameRange {
  int first = 0, last = 0;
  bool all() const { return first == 0 && last == 0; }
};

/// A run's folder, opened: stages read the resolved scene and run.json from it.
struct RunFolder {
  std::filesystem::path folder;
  model::Scene scene;
  RunRecord record;
  std::shared_ptr<RunLock> lock{};  ///< while a stage works; null for a folder that is only read
  std::filesystem::path chunk{};    ///< where tables, costs and log go; empty: where those of the run lie (chunk.h)

  /// The frames that are simulated and that the scene asks for, from 1.
  std::vector<int> frames() const;
  /// Frames `first` to `last`; 0, 0: all. Throws InputError for one that is not simulated.
  std::vector<int> chosen(int first, int last) const;
  /// What run.json has of a frame. Throws InputError if it is not simulated.
  const FrameRecord& frame_record(int frame) const;
  std::string state_hash(int frame) const;
  std::filesystem::path particles(int frame) const;
  /// Which frames of the stage are made, chunks included.
  FrameTable table(const std::string& stage) const;
  std::filesystem::path log_file() const { return (chunk.empty() ? folder : chunk) / "log.txt"; }
  void save_record() const;
};

enum class Access { read, write };

/// Throws InputError if the folder is not there, is no run, or its scene.yaml or run.json is
/// damaged; with `write` also if another process works in it. Models need not be there.
RunFolder open_run(const std::filesystem::path& folder, Access access = Access::read);

/// Throws InputError where the folder has a run that is whole, or that can go on from a checkpoint:
/// hours may be in it.
void refuse_to_replace(const std::filesystem::path& folder);

}  // namespace dreampm
