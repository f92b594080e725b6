// What lies in a run's folder, and which of its frames are up to date.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/io/run_record.h"
#include "dreampm/model/scene.h"
#include "dreampm/pipeline/run_lock.h"

namespace dreampm {

/// A run's folder, opened: stages read the resolved scene and run.json from it.
struct RunFolder {
  std::filesystem::path folder;
  model::Scene scene;
  RunRecord record;
  std::shared_ptr<RunLock> lock{};  ///< while a stage works; null for a folder that is only read

  /// The frames that are simulated and that the scene asks for, from 1.
  std::vector<int> frames() const;
  /// Frames `first` to `last`; 0, 0: all. Throws InputError for one that is not simulated.
  std::vector<int> chosen(int first, int last) const;
  /// What run.json has of a frame. Throws InputError if it is not simulated.
  const FrameRecord& frame_record(int frame) const;
  std::string state_hash(int frame) const;
  std::filesystem::path particles(int frame) const;
  void save_record() const { record.save(folder / "run.json"); }
};

enum class Access { read, write };

/// Throws InputError if the folder is not there, is no run, or its scene.yaml or run.json is
/// damaged; with `write` also if another process works in it. Models need not be there.
RunFolder open_run(const std::filesystem::path& folder, Access access = Access::read);

/// Throws InputError where the folder has a run that is whole, or that can go on from a checkpoint:
/// hours may be in it.
void refuse_to_replace(const std::filesystem::path& folder);

/// What a product depends on, as named hashes: {"simulation", ".."}, {"surface settings", ".."}.
using Identity = std::vector<std::pair<std::string, std::string>>;

/// Which frames of a stage exist, and what they were made from: STAGE/frames.csv. A frame is
/// entered after its files are whole and taken out before they are touched, so that a killed run
/// never leaves a wrong entry.
class FrameTable {
 public:
  /// Reads the file; one that is missing or damaged is an empty table.
  explicit FrameTable(std::filesystem::path file);
  /// Empty if the frame was made from the same; else what changed since, or "new".
  std::string why_redo(int frame, const Identity& identity) const;
  void enter(int frame, const Identity& identity);
  void remove(int frame);
  std::vector<int> frames() const;

 private:
  void save() const;
  std::filesystem::path file_;
  std::vector<std::string> names_;
  std::map<int, std::vector<std::string>> rows_;
};

}  // namespace dreampm
