// What the probes of a run measure, in files.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/io/series.h"
#include "dreampm/simulation/probe_set.h"

namespace dreampm {

template <class R>
class ProbeFiles {
 public:
  /// Throws as ProbeSet does.
  ProbeFiles(const model::Scene& scene, const InitialState& start, const std::string& file,
             std::filesystem::path folder)
      : folder_(std::move(folder)), set_(scene, start, file) {}
  /// New files; those of earlier runs are removed.
  void begin();
  /// Goes on from a checkpoint at `time` [s]: rows after it are cut. Throws InputError if a probe
  /// is new or another one since, or its file is gone.
  void resume(const ProbeMemories& memories, double time);
  /// Writes a row of every probe that is due. What `fields_due` of the set says must be current.
  void write(const World<R>& world, const Motion<R>& motion, bool frame_done) {
    set_.sample(world, motion, frame_done,
                [&](std::size_t probe, const std::vector<double>& row) { files_[probe]->append(world.time, row); });
  }
  ProbeSet<R>& set() { return set_; }

 private:
  std::filesystem::path file_of(std::size_t probe) const { return folder_ / (set_.name(probe) + ".csv"); }

  std::filesystem::path folder_;
  ProbeSet<R> set_;
  std::vector<std::unique_ptr<SeriesWriter>> files_;  ///< by probe
};

}  // namespace dreampm
