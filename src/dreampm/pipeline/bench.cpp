#include "dreampm/pipeline/bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/io/run_record.h"
#include "dreampm/math/rng.h"
#include "dreampm/physics/materials.h"
#include "dreampm/solver/step.h"

namespace dreampm {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds up the time of each verb of another backend.
class Stopwatch final : public Backend<float> {
  template <class F>
  auto timed(const char* stage, const F& f) {
    const auto start = Clock::now();
    auto result = f();
    seconds[stage] += std::chrono::duration<double>(Clock::now() - start).count();
    return result;
  }

 public:
  std::map<std::string, double> seconds;
  explicit Stopwatch(std::unique_ptr<Backend<float>> inner) : inner_(std::move(inner)) {}
  std::string_view name() const override { return inner_->name(); }
  std::string_view isa() const override { return inner_->isa(); }
  void adopt(const World<float>& world) override { inner_->adopt(world); }
  void sort(World<float>& world) override {
    timed("sort", [&] {
      inner_->sort(world);
      return true;
    });
  }
  PassStats birth(World<float>& world, std::size_t set, std::span<const Newborn> newborns) override {
    return inner_->birth(world, set, newborns);
  }
  GridStats grid_update(World<float>& world, double dt) override {
    return timed("grid", [&] { return inner_->grid_update(world, dt); });
  }
  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    return timed("particles", [&] { return inner_->g2p2g(world, dt, dt_next, motion); });
  }

 private:
  std::unique_ptr<Backend<float>> inner_;
};

constexpr double bench_dx = 0.02, bench_spacing = bench_dx / 2;

/// A cube of n^3 cells in the corner of a box twice as long.
World<float> column(const MaterialInfo& material, int n, std::vector<std::vector<Newborn>>& newborns) {
  World<float> w;
  w.dx = bench_dx;
  w.high = {2 * n, n + n / 2 + 2, n};
  w.gravity = {0, -9.81, 0};
  ParticleSet<float> set;
  set.name = set.material = std::string(material.name);
  set.liquid = material.liquid;
  set.values.with_defaults(material.params);
  if (material.find("bulk_modulus") && !set.values.has("bulk_modulus")) {
    const double c2 = 2 * 9.81 * n * bench_dx / set.values["max_compression"];
    set.values.set("bulk_modulus", set.values["density"] * c2);
  }
  set.rest_volume = std::pow(bench_spacing, 3);
  set.mass = set.values["density"] * set.rest_volume;
  w.sets.push_back(std::move(set));
  newborns.resize(1);
  std::uint32_t id = 0;
  for (int i = 0; i < 2 * n; ++i)
    for (int j = 0; j < 2 * n; ++j)
      for (int k = 0; k < 2 * n; ++k) {
        const auto offset = [&](std::uint64_t axis) { return 0.5 * (uniform(axis, id) - 0.5); };
        const Vec3d p{i + 0.5 + offset(1), j + 0.5 + offset(2), k + 0.5 + offset(3)};
        newborns[0].push_back({id++, p * bench_spacing, {}, {}});
      }
  return w;
}

double memory_of(const World<float>& w) {
  double bytes = static_cast<double>(w.grid.nodes.size()) * sizeof(Node<float>) * 2;
  for (const auto& s : w.sets)
    bytes += static_cast<double>(s.size()) * (4 + 12 + 4 * static_cast<double>(s.state.size()));
  return bytes;
}

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

StepBenchResult bench_step(const StepBenchOptions& options) {
  const MaterialInfo* material = find_material(options.material);
  if (!material) {
    std::string names;
    for (const MaterialInfo& m : material_infos()) names += (names.empty() ? "" : ", ") + std::string(m.name);
    fail_input("--material {}: there is no such material; there are {}", options.material, names);
  }
  if (options.particles < 64 || options.particles > 200000000)
    fail_input("--particles {}: give 64 to 200000000", options.particles);
  const ThreadLimit threads(options.threads);
  Stopwatch backend(make_cpu_backend(options.isa));
  const int n = std::max(2, static_cast<int>(std::lround(std::cbrt(static_cast<double>(options.particles) / 8))));
  std::vector<std::vector<Newborn>> newborns;
  World<float> world = column(*material, n, newborns);
  begin(world, backend, newborns);
  newborns = {};
  // Matter must be moving, or sorting would cost nothing.
  for (int i = 0; i < 20; ++i) step<float>(world, backend, nullptr);

  StepBenchResult r;
  r.material = options.material;
  r.isa = std::string(backend.isa());
  r.particles = world.particles();
  r.threads = options.threads;
  backend.seconds.clear();
  double total = 0;
  for (int window = 0; window < options.windows; ++window) {
    const auto start = Clock::now();
    double seconds = 0;
    int steps = 0;
    while (steps == 0 || seconds < options.window_seconds) {
      step<float>(world, backend, nullptr);
      ++steps;
      seconds = std::chrono::duration<double>(Clock::now() - start).count();
    }
    total += seconds;
    r.windows.push_back(seconds * 1e9 / steps / static_cast<double>(r.particles));
  }
  std::vector<double> sorted = r.windows;
  std::sort(sorted.begin(), sorted.end());
  r.ns_per_particle_step = sorted[sorted.size() / 2];
  r.mps = 1e3 / r.ns_per_particle_step;
  for (const auto& [stage, seconds] : backend.seconds) r.stages[stage] = seconds / total;
  r.bytes_per_particle = memory_of(world) / static_cast<double>(r.particles);
  r.peak_memory_bytes = peak_memory_bytes();
  return r;
}

}  // namespace dreampm
