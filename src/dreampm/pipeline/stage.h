// What the stages have in common: frames that are up to date are skipped, the others made one after
// the other, with progress, a stop between frames, and their cost in run.json.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "dreampm/pipeline/run_folder.h"

namespace dreampm {

struct StageWork {
  std::string name;           ///< surface or render: the folder, and the key in run.json
  std::string settings_hash;  ///< of the scene's keys it depends on, for run.json
  std::vector<int> frames;    ///< asked for
  bool all_frames = true;     ///< these are all of the run: files of other frames are removed
  std::function<Identity(int frame)> identity;
  std::function<std::vector<std::filesystem::path>(int frame)> products;
  std::function<void(int frame)> make;
  /// What other settings would have called a frame's files: removed with it and once it is made,
  /// because they would show another run's matter. May be empty.
  std::function<std::vector<std::filesystem::path>(int frame)> leftovers{};
};

struct StageResult {
  int made = 0;
  std::string why;  ///< what changed, for the first frame that was made again; "new" if none was there
};

/// Makes what is not up to date and says what it does. Throws Interrupted between frames when asked
/// to stop. How it ended is in run.json.
StageResult run_stage(RunFolder& run, const StageWork& work);

/// Why a frame's product of this stage is missing or not up to date, and what makes it; empty if
/// all are.
std::string not_up_to_date(const RunFolder& run, const std::string& stage, const std::vector<int>& frames,
                           const std::function<Identity(int frame)>& identity);

/// Adds a stage's cost to run.json when it goes out of scope, also on the way of an error.
class StageCost {
 public:
  StageCost(RunFolder& run, std::string stage);
  ~StageCost();
  StageCost(const StageCost&) = delete;
  StageCost& operator=(const StageCost&) = delete;
  /// Writes what it cost so far. Throws if run.json cannot be written.
  void save();
  /// Frames in the folder now, and what they were made with.
  void frames(std::size_t count, const std::string& settings_hash);

 private:
  RunFolder& run_;
  StageRecord& stage_;
  double before_, start_;
};

/// Calls `work` and puts into the run's record how it ended: complete (nothing, for some of the
/// frames only), interrupted, or failed with its cause. Takes the folder's lock if it is not held.
void record_end(RunFolder& run, const std::string& stage, bool all_frames, const std::function<void()>& work);

}  // namespace dreampm
