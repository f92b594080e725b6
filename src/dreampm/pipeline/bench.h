// How fast the step is, here and now.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace dreampm {

struct StepBenchOptions {
  std::string material = "newtonian";
  std::uint64_t particles = 1000000;  ///< rounded to whole cells of 8
  int threads = 1;
  std::string isa = "auto";
  int windows = 5;              ///< the median of so many is the result
  double window_seconds = 0.5;  ///< at least this long each
};

struct StepBenchResult {
  std::string material, isa;
  std::uint64_t particles = 0;
  int threads = 1;
  double ns_per_particle_step = 0;       ///< median
  double mps = 0;                        ///< million particle-steps a second
  std::map<std::string, double> stages;  ///< share of the time: grid, particles, sort
  double bytes_per_particle = 0;         ///< columns and grid
  std::uint64_t peak_memory_bytes = 0;
  std::vector<double> windows;  ///< ns per particle-step of each
};

/// What the machine itself can do at most, now.
struct Ceilings {
  double fma_gflops = 0;  ///< multiply-adds of float in all lanes, each counted twice [1e9/s]
  double triad_gb_s = 0;  ///< a = b + s c over memory far larger than caches, three floats an element [1e9 B/s]
};

/// The best of several tries, a second in all. Throws InputError for an instruction set that is not there.
Ceilings measure_ceilings(const std::string& isa, int threads);

/// A column of matter, 8 particles a cell, collapses in a box; sorting, grid and dt are all counted. Throws InputError
/// for a material or instruction set that is not there.
StepBenchResult bench_step(const StepBenchOptions& options);

}  // namespace dreampm
