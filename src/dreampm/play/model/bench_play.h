// How fast the playground is beside the bare step, here and now.
#pragma once
#include <string>
#include <string_view>

namespace dreampm::play {

struct PlayBenchOptions {
  std::string_view material = "newtonian";  ///< or seed
  int particles = 65536;                    ///< 65536 or 8192
  int threads = 0;                          ///< 0: all cores
  double seconds = 2;                       ///< of the wall clock, for each measurement
  int turns = 3;                            ///< of both, of which the medians count
};

struct PlayBenchResult {
  int particles = 0;
  double play = 0;  ///< million particle-steps a second, with a push, a frame and the past in every 25 steps
  double step = 0;  ///< the same of `dreampm bench step`
  double ratio = 0;
};

/// Throws InputError for another material or number.
PlayBenchResult bench_play(const PlayBenchOptions& options);

}  // namespace dreampm::play
