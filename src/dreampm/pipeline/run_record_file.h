// Keeps run.json while an engine steps.
#pragma once
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "dreampm/io/run_record.h"
#include "dreampm/pipeline/backend_choice.h"
#include "dreampm/pipeline/run_lock.h"
#include "dreampm/run/ledger_observer.h"
#include "dreampm/run/ledger_row.h"
#include "dreampm/setup/assemble.h"

namespace dreampm {

/// Where a scene came from, for messages and run.json.
struct SceneSource {
  std::string path;
  std::optional<std::string> variant;
};

/// Where colliders stand that the scene does not move itself, by name.
template <class R>
std::map<std::string, Pose> poses_of(const World<R>& world);

template <class R>
class RunRecordFile final : public Observer {
 public:
  /// `totals` and `ledger`: of the same engine, added to it before.
  RunRecordFile(Engine<R>& engine, const FrameTotals<R>& totals, const LedgerObserver<R>& ledger,
                std::filesystem::path folder, std::shared_ptr<RunLock> lock)
      : engine_(engine), totals_(totals), ledger_(ledger), folder_(std::move(folder)), lock_(std::move(lock)) {}

  /// A new record.
  void begin(const Vec3d& shift);
  /// That of the folder, up to the world's frame, which `before` computed.
  void go_on(const BackendChoice& before);
  /// What the run is: from now on it counts as interrupted until it ends.
  void describe(const model::Scene& scene, const SceneSource& source, const std::string& scene_hash,
                const InitialState& start);
  const Vec3d& shift() const { return record_.shift; }
  void add_warning(const std::string& warning) { record_.warnings.push_back(warning); }
  void save();
  /// How the stage ended.
  void end(const std::string& status, std::optional<std::string> cause = std::nullopt);
  /// As `end` of a failure, where the disk may be what failed: the first cause is the one to
  /// report.
  void end_failed(const std::string& cause);

  /// Enters the frame that has ended.
  void on_frame() override;

 private:
  /// Once a run, however often it was resumed.
  void warn_of_volume(const std::string& warning);

  Engine<R>& engine_;
  const FrameTotals<R>& totals_;
  const LedgerObserver<R>& ledger_;
  std::filesystem::path folder_;
  std::shared_ptr<RunLock> lock_;
  RunRecord record_;
  SwollenWatch swollen_;
  double earlier_seconds_ = 0;
  std::chrono::steady_clock::time_point start_clock_ = std::chrono::steady_clock::now();
};

}  // namespace dreampm
