#include "dreampm/play/model/bench_play.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "bench/bench.h"
#include "dreampm/base/parallel.h"
#include "dreampm/error.h"
#include "dreampm/play/model/playground.h"

namespace dreampm::play {
namespace {

/// A column of 8 particles a cell, twice as long as it is high and wide, in a box three times as
/// wide.
PlayScene column(std::string_view material, int particles) {
  const int side = static_cast<int>(std::lround(std::cbrt(particles / 16.0)));
  if (16 * side * side * side != particles)
    throw InputError(fmt::format("bench play: {} particles are not 16 times a cube, as 8192 and 65536 are", particles));
  const double dx = 1.0 / (3 * side), spacing = dx / 2;
  const std::string text = material == "newtonian" ? "{type: newtonian, preset: water}"
                           : material == "seed"    ? "{type: seed, density: 1000, youngs_modulus: 1.0e5}"
                                                   : throw InputError(fmt::format("bench play: material {}", material));
  return {
      "column",
      parse_scene(
          fmt::format("dreampm: 1\nname: column\nspace: {{min: [0, 0, 0], max: [1, {0}, {0}], spacing: {1}}}\n"
                      "time: {{fps: 60}}\nmaterials: {{matter: {2}}}\nbodies: {{column: {{material: matter, "
                      "shape: {{box: {{min: [0, 0, 0], max: [{3}, {4}, {4}]}}}}, sample: {{pattern: lattice}}}}}}\n",
                      2 * side * dx, spacing, text, 2 * side * dx, side * dx),
          "column.yaml")};
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

/// Million particle-steps a second.
double rate_of(Playground& p, double seconds, double& angle) {
  using Clock = std::chrono::steady_clock;
  const auto began = Clock::now();
  std::uint64_t done = 0;
  double taken = 0;
  while (taken < seconds) {
    // A stroke that stirs.
    angle += 0.1;
    p.act({"push",
           {text_of(0.3 + 0.2 * std::cos(angle)), "0.1", text_of(0.3 + 0.2 * std::sin(angle)), "0.1",
            text_of(-std::sin(angle)), "0", text_of(std::cos(angle))}});
    done += static_cast<std::uint64_t>(p.tick({report_substeps, {}}));
    p.frame();
    taken = std::chrono::duration<double>(Clock::now() - began).count();
  }
  return 1e-6 * static_cast<double>(done) * static_cast<double>(p.simulation().particle_count()) / taken;
}

}  // namespace

PlayBenchResult bench_play(const PlayBenchOptions& options) {
  SilentHost silent;
  PlayOptions play;
  play.simulation.threads = options.threads, play.simulation.host = &silent;
  Playground playground(column(options.material, options.particles), play);
  const int threads = options.threads > 0 ? options.threads : thread_count();
  StepBenchOptions step;
  step.material = std::string(options.material), step.particles = static_cast<std::uint64_t>(options.particles);
  step.threads = threads, step.windows = 3, step.window_seconds = options.seconds / 3;
  std::vector<double> plays, steps, ratios;
  double angle = 0;
  rate_of(playground, 0.5, angle);
  for (int turn = 0; turn < options.turns; ++turn) {
    steps.push_back(bench_step(step).mps);
    plays.push_back(rate_of(playground, options.seconds, angle));
    ratios.push_back(plays.back() / steps.back());
  }
  return {static_cast<int>(playground.simulation().particle_count()), median(plays), median(steps), median(ratios)};
}

}  // namespace dreampm::play
