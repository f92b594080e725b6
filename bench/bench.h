// How fast the step is, here and now.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/bench_backend.h"
#include "dreampm/math/vec.h"

namespace dreampm {

struct StepBenchOptions {
  std::string material = "newtonian";
  std::uint64_t particles = 1 << 20;  ///< rounded to a column of whole cells of 8, of the shape 2:2:1
  std::optional<Vec3i> cells;         ///< the column's cells, instead of `particles`
  bool droplets = false;              ///< `particles` in drops of 8 that are far apart, instead of a column
  bool large_steps = false;           ///< of the projection, for bench_taps
  int threads = 1;
  BenchBackend backend;
  int windows = 5;              ///< the result is the median of this number of windows
  double window_seconds = 0.5;  ///< at least this long each
  /// Called after every window with its ns per particle-step: wall clock, and processor time of all
  /// threads.
  std::function<void(double, double)> each;
};

struct StepBenchResult {
  std::string material, backend;
  std::string isa;     ///< or the kind of device
  std::string device;  ///< a line about it; empty for processors
  std::uint64_t particles = 0;
  Vec3i cells;  ///< of the column, or of a droplet
  bool droplets = false;
  int threads = 1;
  double ns_per_particle_step = 0;       ///< median, wall clock
  double cpu_ns = 0;                     ///< median, processor time of all threads
  double mps = 0;                        ///< million particle-steps a second
  double spread = 0;                     ///< half the distance of the windows' quartiles, over the median
  std::map<std::string, double> stages;  ///< share of the time: grid, particles, sort
  double steps_per_sort = 0;
  double bytes_per_particle = 0;   ///< columns and grids
  double memory_per_particle = 0;  ///< what the process took at most while stepping, all in [B]; 0: not known
  std::uint64_t peak_memory_bytes = 0;
  double device_memory_per_particle = 0;  ///< B; 0: not known, or no device
  double operations = 0;   ///< instructions of a particle-step for the units of multiply-adds, in one lane: the set's
                           ///< multiply-adds, one or two each, multiplications, additions, divisions, roots
  double bytes_moved = 0;  ///< of a particle-step, at least
  std::vector<double> windows, cpu_windows;  ///< ns per particle-step of each
};

/// Upper bounds of the machine itself, measured now.
struct Ceilings {
  double fma_gflops = 0;  ///< multiply-adds of float in all lanes, each counted twice [1e9/s]
  double triad_gb_s = 0;  ///< a = b + s c over memory far larger than caches, three floats an element [1e9 B/s]
};

/// No step of these formulas can take less [ns per particle-step]: its operations at one a slot of
/// the units for multiply-adds, and its bytes at the speed of memory.
struct Floors {
  double fma_ns = 0, bandwidth_ns = 0;
};
Floors floors_of(const StepBenchResult& result, const Ceilings& ceilings);

/// The best of several tries, a second in all. Throws InputError for an instruction set that is not
/// there.
Ceilings measure_ceilings(const std::string& isa, int threads);

/// A column of matter, 8 particles a cell, moves and collapses in a box; sorting, grid and dt are
/// all counted. Throws InputError for a material, backend or instruction set that is not there.
StepBenchResult bench_step(const StepBenchOptions& options);

/// One line of the table.
struct BenchRow {
  std::string what;
  std::uint64_t particles = 0;
  std::string isa;  ///< or the kind of device
  int threads = 1;
  std::optional<double> value;  ///< absent: not run here
  std::string unit;             ///< "M/s", "x", "B", "%"
  double spread = 0;            ///< of the windows, over the median
  std::string note;             ///< limits, floors, shares; the reason where it was not run, if there is more to say
  std::string backend = "cpu";
};

/// Measures the cost of a particle-step of the projection, in calm water and in a splash: with one
/// thread, and where there are more also with all of them. Takes particles or cells, threads and
/// windows of the options. Throws InputError for one that it does not have.
std::vector<BenchRow> bench_projection(const StepBenchOptions& options);

/// A source, sink, collider or edit beside the steps.
enum class Tap {
  emitter,  ///< brings matter in from above
  sink,     ///< takes what comes to the middle of the floor
  moving,   ///< a mesh of some thousand faces turns in the matter, where it stood before
  edit      ///< a value of the material changes before every step
};

/// Measures three rows for each tap: the step without it, the step with it, and its cost in shares
/// of the step [%]. Both start from the same matter in motion, and take turns. Takes all of the
/// options but droplets. Throws InputError for one that it does not have.
std::vector<BenchRow> bench_taps(const StepBenchOptions& options, const std::vector<Tap>& taps);

struct TableOptions {
  std::string isa;  ///< only this one; empty: all that the machine has
  int shrink = 1;   ///< divides the lengths of every scene: to see that it works, not how fast
  int windows = 5;  ///< of each row
  double window_seconds = 0.4;
  std::function<void(const BenchRow&)> each;  ///< called with every row as it comes, if there is one
};

struct DeviceTableOptions {
  std::string backend;              ///< one with a device
  std::uint64_t largest = 1 << 26;  ///< no row has more particles
  int windows = 5;                  ///< of each row
  double window_seconds = 0.4;
  std::function<void(const BenchRow&)> each;  ///< called with every row as it comes, if there is one
};

/// Steps of columns of 8,192 to 64 million particles on a device, by the clock, with all threads
/// that may be used; what the device has no room for, judged by the rows before, is not run. Takes
/// minutes. Throws InputError for a backend without a device, or where there is none.
std::vector<BenchRow> bench_device_table(const DeviceTableOptions& options);

/// Every case that the project watches. One thread is measured in processor time, more by the
/// clock. Takes minutes. Throws InputError for an instruction set or backend that is
/// not there.
std::vector<BenchRow> bench_table(const TableOptions& options);

}  // namespace dreampm
