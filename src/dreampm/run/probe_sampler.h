// Samples the probes of a scene while an engine steps.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "dreampm/run/engine.h"
#include "dreampm/run/probe_set.h"

namespace dreampm {

/// Takes a row of a probe, by its number, at a time [s].
using ProbeRowTaker = std::function<void(std::size_t probe, double time, const std::vector<double>& row)>;

template <class R>
class ProbeSampler final : public Observer {
 public:
  ProbeSampler(Engine<R>& engine, ProbeSet<R> set) : engine_(engine), set_(std::move(set)) {}
  ProbeSet<R>& set() { return set_; }
  /// Takers are called in the order in which they were added.
  void add(ProbeRowTaker taker) { takers_.push_back(std::move(taker)); }
  /// Samples the probes that are due now.
  void sample(bool frame_done) {
    const World<R>& world = engine_.world();
    engine_.download(set_.fields_due(world.time, frame_done));
    set_.sample(world, engine_.motion(), frame_done, [&](std::size_t probe, const std::vector<double>& row) {
      for (const ProbeRowTaker& take : takers_) take(probe, world.time, row);
    });
  }

  double next_sample_time() const override { return set_.next(); }
  void on_step(const StepSums& step) override {
    const bool due = step.frame_done || engine_.world().time >= set_.next();
    set_.accumulate(step);
    if (due) sample(step.frame_done);
  }

 private:
  Engine<R>& engine_;
  ProbeSet<R> set_;
  std::vector<ProbeRowTaker> takers_;
};

}  // namespace dreampm
