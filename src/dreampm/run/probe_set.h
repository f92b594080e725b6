// The probes of a running scene: when each samples, and its state in a checkpoint.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dreampm/setup/assemble.h"
#include "dreampm/solver/probe/probe.h"

namespace dreampm {

/// The memory of one probe, by its name.
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
  ProbeSet(const model::Scene& scene, const InitialState& start, const std::string& file);
  std::size_t size() const { return all_.size(); }
  const std::string& name(std::size_t probe) const { return all_[probe].name; }
  /// Returns the names of a probe's columns, without the time.
  std::vector<std::string> columns(std::size_t probe) const { return all_[probe].probe->columns(); }

  /// Goes on from a time [s]. Throws InputError if a probe is not in the memories, or was another
  /// one.
  void resume(const ProbeMemories& memories, double time);
  /// Returns the time of the next sample within a frame [s]; infinity if none is due.
  double next() const;
  /// Adds a step to the running means; after every step.
  void accumulate(const StepSums& step);
  /// Returns the fields that `sample` will read at a time [s].
  MatterFields fields_due(double time, bool frame_done) const;
  /// Calls `take(probe, row)` for every probe that is due and has a row: at the end of a frame
  /// those without a rate, at the end of a step those whose sample time has come. What `fields_due`
  /// says must be current.
  template <class Take>
  void sample(const World<R>& world, const Motion<R>& motion, bool frame_done, const Take& take) {
    for (std::size_t p = 0; p < all_.size(); ++p) {
      if (!is_due(all_[p], world.time, frame_done)) continue;
      passed(all_[p], world.time);
      if (const auto row = all_[p].probe->sample({world, motion})) take(p, *row);
    }
  }
  ProbeMemories memories() const;

 private:
  struct One {
    std::string name, identity;
    double rate;
    std::unique_ptr<Probe<R>> probe;
    double taken = -1;  ///< number of the last sample time that has come
  };
  static bool is_due(const One& one, double time, bool frame_done);
  static void passed(One& one, double time);

  std::vector<One> all_;
};

}  // namespace dreampm
