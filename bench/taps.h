// The cost of a step beside which matter comes in, goes out, meets a mesh that turns, or is edited.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "bench/bench.h"
#include "bench/course.h"
#include "dreampm/run/engine.h"

namespace dreampm {

/// The steps of one world, again and again from the same state.
class TappedSteps {
 public:
  /// Water or another material with a tap, moved far enough for all to be warm. With the threads
  /// that may be used.
  TappedSteps(const StepBenchOptions& options, Tap tap, const BenchBackend& choice);
  /// The same matter, as it moves then, without the tap; of a mesh that turns: that stands still.
  TappedSteps without_tap(const BenchBackend& choice) const;

  std::uint64_t particles() const { return start_->particles(); }
  /// Steps from the start for at least that long. Adds what a particle-step took [ns].
  void run_window(double seconds, Timing& timing);

 private:
  TappedSteps() = default;
  void step();

  std::optional<Tap> tap_;
  int steps_per_piece_ = 1;
  bool grows_ = true;  ///< what the edit changes
  std::unique_ptr<Engine<float>> engine_;
  std::unique_ptr<const World<float>> start_;
};

}  // namespace dreampm
