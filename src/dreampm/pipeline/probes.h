// The probes of a running scene: when each samples, its file, and its state in a checkpoint.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/io/series.h"
#include "dreampm/simulation/assemble.h"
#include "dreampm/solver/probe/probe.h"

namespace dreampm {

/// Of one probe, by its name.
struct ProbeMemory {
  std::string identity;  ///< of what it measures
  std::vector<double> values;
};
using ProbeMemories = std::map<std::string, ProbeMemory>;

template <class R>
class ProbeSet {
 public:
  /// Throws InputError with every probe that can measure nothing; `file` names the scene there.
  /// `start` must still hold its seeds.
  ProbeSet(const SceneDescription& scene, const InitialState& start, const std::string& file,
           std::filesystem::path folder);
  /// New files; those of earlier runs are removed.
  void begin();
  /// Goes on from a checkpoint at `time` [s]: rows after it are cut. Throws InputError if a probe
  /// is new or another one since, or its file is gone.
  void resume(const ProbeMemories& memories, double time);
  /// When the next one is due within a frame [s]; infinity if none is.
  double next() const;
  /// After every step.
  void accumulate(const StepSums& step);
  /// What `look` will read at a time [s].
  MatterFields fields_due(double time, bool frame_done) const;
  /// Writes a row of every probe that is due: at the end of a frame those without a rate, at the
  /// end of a step those whose sample time has come. What `fields_due` says must be current.
  void look(const World<R>& world, const Motion<R>& motion, bool frame_done);
  ProbeMemories memories() const;

 private:
  struct One {
    std::string name, identity;
    double rate;
    std::unique_ptr<Probe<R>> probe;
    std::unique_ptr<SeriesWriter> file;
    double taken = -1;  ///< number of the last sample time that has come
  };
  static bool is_due(const One& one, double time, bool frame_done);
  std::filesystem::path file_of(const std::string& name) const { return folder_ / (name + ".csv"); }

  std::filesystem::path folder_;
  std::vector<One> all_;
};

}  // namespace dreampm
