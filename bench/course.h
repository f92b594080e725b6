// Measures the steps of a world, again and again from the same state, so that every window does the
// same work.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/bench_backend.h"
#include "bench/scenes.h"

namespace dreampm {

/// Nanoseconds per particle-step, and where they went.
struct Timing {
  std::vector<double> windows;           ///< wall clock, in the order measured
  std::vector<double> cpu_windows;       ///< processor time of all threads: what other programs take is not in it
  std::map<std::string, double> stages;  ///< share of the time: grid, particles, sort
  double steps_per_sort = 0;
  double median() const;
  double cpu_median() const;
  /// Returns the times by the clock where several threads share the work; for one thread its
  /// processor time, which is the same on a quiet machine and leaves out what other programs take
  /// on a busy one.
  const std::vector<double>& fair(int threads) const { return threads == 1 ? cpu_windows : windows; }
};

/// The middle of an odd number, the upper of two of an even one.
double median_of(std::vector<double> values);
/// (q75 - q25)/2 over the median.
double spread_of(std::vector<double> values);

struct Pace {
  int windows = 5;
  double window_seconds = 0.5;                         ///< at least
  std::function<void(double ns, double cpu_ns)> each;  ///< called after every window, if there is one
};

/// A world that has moved far enough for everything to be warm, just after a sort.
class Course {
 public:
  /// Begins the scene and steps it with all threads that may be used.
  Course(BenchScene scene, const BenchBackend& choice);

  const World<float>& world() const { return *start_; }
  /// Windows of whole periods from sort to sort, in pieces of a few periods from the start of the
  /// course.
  Timing run(const BenchBackend& choice, const Pace& pace) const;
  /// Memory that the process took for it, seeds apart, over particles [B]: at most, while it warmed
  /// up. 0: not known, or too little to measure.
  double memory_per_particle() const { return memory_; }
  /// The same of a device's memory.
  double device_memory_per_particle() const { return device_memory_; }

 private:
  std::unique_ptr<const World<float>> start_;
  double memory_ = 0, device_memory_ = 0;
};

/// Returns the size of a world's arrays, and of the second grid of a step, over particles [B].
double bytes_per_particle(const World<float>& world);

}  // namespace dreampm
