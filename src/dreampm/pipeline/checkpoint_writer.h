// The checkpoints of a run's folder: written as it goes, and the newest that can be read.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dreampm/pipeline/checkpoint.h"
#include "dreampm/run/probe_sampler.h"

namespace dreampm {

/// Checkpoints in a folder by the step of their frame, newest first.
std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& folder);

/// A run as a checkpoint has it.
template <class R>
struct SavedRun {
  std::filesystem::path file;
  World<R> world;
  CheckpointInfo info;
};
/// The newest checkpoint that can be read, over the `empty` world of its scene; nothing in a folder
/// without any. It warns of those that cannot be read; throws InputError where none can.
template <class R>
std::optional<SavedRun<R>> newest_checkpoint(const std::filesystem::path& folder, const World<double>& empty,
                                             const std::string& scene_hash);

/// Writes checkpoints while an engine steps, and removes the oldest.
template <class R>
class CheckpointWriter final : public Observer {
 public:
  /// When frames have one.
  struct When {
    int every = 0;  ///< frames; 0: only the last
    int last = 1;
  };
  /// `totals`: of the same engine, added to it before.
  CheckpointWriter(Engine<R>& engine, const FrameTotals<R>& totals, const ProbeSet<R>& probes, std::string scene_hash,
                   std::filesystem::path folder, const When& when)
      : engine_(engine),
        totals_(totals),
        probes_(probes),
        scene_hash_(std::move(scene_hash)),
        folder_(std::move(folder)),
        when_(when) {}
  /// One of the moment at hand.
  void write();

  void on_frame() override;

 private:
  Engine<R>& engine_;
  const FrameTotals<R>& totals_;
  const ProbeSet<R>& probes_;
  std::string scene_hash_;
  std::filesystem::path folder_;
  When when_;
};

}  // namespace dreampm
