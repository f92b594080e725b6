// What a step costs beside which matter comes in, goes out, meets a mesh that turns, or is edited.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "dreampm/pipeline/bench.h"
#include "dreampm/pipeline/bench/course.h"
#include "dreampm/run/engine.h"

namespace dreampm {

/// A mesh of some thousand faces in the matter.
enum class Rotor { none, stands, turns };

/// The steps of one world, again and again from the same state.
class TappedSteps {
 public:
  /// Water or another material with one of the taps, or none, moved far enough for all to be warm.
  /// With the threads that may be used.
  TappedSteps(const StepBenchOptions& options, std::optional<Tap> tap, Rotor rotor, const std::string& isa);

  std::uint64_t particles() const { return start_->particles(); }
  /// Steps from the start for at least that long. Adds what a particle-step took [ns].
  void run_window(double seconds, Timing& timing);

 private:
  void step();

  std::optional<Tap> tap_;
  int steps_per_piece_;
  bool grows_ = true;  ///< what the edit changes
  std::unique_ptr<Engine<float>> engine_;
  std::unique_ptr<const World<float>> start_;
};

}  // namespace dreampm
