#include "bench/bench.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "bench/course.h"
#include "bench/large_steps.h"
#include "bench/operations.h"
#include "bench/scenes.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/run_record.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

using Clock = std::chrono::steady_clock;

/// The largest of `tries` rates: work() says how much it did.
template <class Work>
double best_rate(int tries, const Work& work) {
  double best = 0;
  for (int i = 0; i < tries; ++i) {
    const auto start = Clock::now();
    const double done = work();
    best = std::max(best, done / std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best;
}

}  // namespace

Ceilings measure_ceilings(const std::string& isa, int threads) {
  const ThreadLimit limit(threads);
  const auto workers = static_cast<std::size_t>(thread_count());
  Ceilings c;
  c.fma_gflops = 1e-9 * best_rate(5, [&] {
                   std::vector<std::uint64_t> done(workers);
                   parallel_for(workers, 1, [&](std::size_t i) { done[i] = run_multiply_adds(2'000'000'000, isa); });
                   return static_cast<double>(std::accumulate(done.begin(), done.end(), std::uint64_t{0}));
                 });
  constexpr std::size_t n = 1 << 24, piece = 1 << 16;
  std::vector<float> a(n), b(n, 1), other(n, 2);
  c.triad_gb_s = 1e-9 * best_rate(9, [&] {
                   parallel_ranges(n, piece, [&](std::size_t begin, std::size_t end) {
                     for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + 3.0f * other[i];
                   });
                   return static_cast<double>(3 * sizeof(float) * n);
                 });
  return c;
}

Floors floors_of(const StepBenchResult& result, const Ceilings& ceilings) {
  const double slots = ceilings.fma_gflops / (fuses(result.isa) ? 2 : 1);
  return {result.operations / slots, result.bytes_moved / ceilings.triad_gb_s};
}

std::vector<BenchRow> bench_projection(const StepBenchOptions& options) {
  if (options.material != "newtonian" || options.droplets)
    fail_input("--solver projection: moves water at rest and in a splash; leave --material and --droplets out");
  check_particles(options.particles);
  if (!options.backend.on_host())
    fail_input("--solver projection: it computes on processors; leave --backend {} out", options.backend.backend);
  const std::string isa(make_bench_backend(options.backend)->isa());
  std::vector<BenchRow> rows;
  for (const auto& [waters, name] : {std::pair{Waters::calm, "calm water"}, std::pair{Waters::splash, "a splash"}}) {
    const auto begin = [&] {
      const ThreadLimit all(options.threads);
      return LargeSteps(waters, options.cells.value_or(column_cells(options.particles)), isa);
    };
    const LargeSteps course = begin();
    double alone = 0;
    for (const int threads : options.threads > 1 ? std::vector{1, options.threads} : std::vector{1}) {
      const ThreadLimit limit(threads);
      const Timing timing = course.run({options.windows, options.window_seconds, options.each});
      const double ns = median_of(timing.fair(threads));
      if (threads == 1) alone = ns;
      rows.push_back(
          {fmt::format("projection, {}", name), course.world().particles(), isa, threads, 1e3 / ns, "M/s",
           spread_of(timing.fair(threads)),
           fmt::format("{:.1f} ns{}", ns,
                       threads == 1 ? "" : fmt::format(", {:.2f} times as fast as one thread", alone / ns))});
    }
  }
  return rows;
}

StepBenchResult bench_step(const StepBenchOptions& options) {
  const MaterialInfo& material = bench_material(options.material);
  check_particles(options.particles);
  const ThreadLimit threads(options.threads);
  StepBenchResult r;
  r.backend = options.backend.backend;
  r.isa = std::string(make_bench_backend(options.backend)->isa());
  if (const auto device = device_of(options.backend)) r.device = device->about;
  r.material = options.material;
  r.cells = options.droplets ? Vec3i{1, 1, 1} : options.cells.value_or(column_cells(options.particles));
  r.droplets = options.droplets;
  r.threads = options.threads;
  const Course course(
      options.droplets ? droplets_scene(material, options.particles / 8) : column_scene(material, r.cells),
      options.backend);
  r.particles = course.world().particles();
  r.memory_per_particle = course.memory_per_particle();
  r.device_memory_per_particle = course.device_memory_per_particle();
  r.peak_memory_bytes = peak_memory_bytes();
  r.operations = static_cast<double>(operations_of(course.world()).slots(fuses(r.isa)));
  r.bytes_moved = bytes_moved_of(course.world());
  r.bytes_per_particle = bytes_per_particle(course.world());

  const Timing timing = course.run(options.backend, {options.windows, options.window_seconds, options.each});
  r.windows = timing.windows, r.cpu_windows = timing.cpu_windows;
  r.ns_per_particle_step = timing.median();
  r.cpu_ns = timing.cpu_median();
  r.mps = 1e3 / r.ns_per_particle_step;
  r.spread = spread_of(timing.windows);
  r.stages = timing.stages;
  r.steps_per_sort = timing.steps_per_sort;
  return r;
}

}  // namespace dreampm
