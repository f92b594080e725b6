#include "bench/course.h"

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include <algorithm>

#include "bench/moment.h"
#include "dreampm/io/run_record.h"
#include "dreampm/solver/form_grid.h"
#include "dreampm/solver/motion_by_id.h"
#include "dreampm/solver/step.h"

namespace dreampm {
namespace {

constexpr int least_warm_steps = 12;
constexpr int periods_per_piece = 4;
/// Bytes: what a process holds counts in pages, and some were there before.
constexpr double least_growth = 1 << 21;
/// Matter that hardly moves is never sorted; a period ends then all the same.
constexpr int longest_period = 40;

/// Adds up the time of each verb of another backend.
class Stopwatch final : public Backend<float> {
  template <class F>
  auto timed(const char* stage, const F& f) {
    const double start = seconds_now();
    auto result = f();
    seconds[stage] += seconds_now() - start;
    return result;
  }

 public:
  std::map<std::string, double> seconds;
  int sorts = 0;
  explicit Stopwatch(std::unique_ptr<Backend<float>> inner) : inner_(std::move(inner)) {}
  std::string_view name() const override { return inner_->name(); }
  std::string_view isa() const override { return inner_->isa(); }
  void attach(const World<float>& world) override { inner_->attach(world); }
  void sort(World<float>& world) override {
    ++sorts;
    timed("sort", [&] {
      inner_->sort(world);
      return true;
    });
  }
  void colliders_moved(const World<float>& world) override { inner_->colliders_moved(world); }
  PassStats insert_particles(World<float>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    return inner_->insert_particles(world, set, seeds);
  }
  GridStats grid_update(World<float>& world, double dt) override {
    return timed("grid", [&] { return inner_->grid_update(world, dt); });
  }
  double sub_cycle(World<float>& world, double dt, GridStats& found) override {
    return timed("viscosity", [&] { return inner_->sub_cycle(world, dt, found); });
  }
  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    return timed("particles", [&] { return inner_->g2p2g(world, dt, dt_next, motion); });
  }
  PassStats state_bounds(const World<float>& world) override { return inner_->state_bounds(world); }
  void scatter_particles(World<float>& world, const Motion<float>& motion) override {
    inner_->scatter_particles(world, motion);
  }
  void download(World<float>& world, Motion<float>& motion, MatterFields fields) override {
    inner_->download(world, motion, fields);
  }
  void upload(const World<float>& world, const Motion<float>& motion, MatterFields fields) override {
    inner_->upload(world, motion, fields);
  }
  Balance balance(const World<float>& world, const Motion<float>& motion) override {
    return inner_->balance(world, motion);
  }
  double stress_power(const World<float>& world, const Motion<float>& motion) override {
    return inner_->stress_power(world, motion);
  }
  ImpulseSum grid_momentum(const World<float>& world, NodesHold hold) override {
    return inner_->grid_momentum(world, hold);
  }

 private:
  std::unique_ptr<Backend<float>> inner_;
};

/// Steps from one sort to the end of the step with the next one. Returns how many.
int period(World<float>& world, Stopwatch& backend) {
  const int before = backend.sorts;
  int steps = 0;
  while (backend.sorts == before && steps < longest_period) {
    step<float>(world, backend, nullptr);
    ++steps;
  }
  return steps;
}

/// Brings the first matter into the world. Its grid is formed of all particles side by side, as
/// after an edit: begin() adds one after the other, which takes a third of a minute for 64 million.
void start(BenchScene& scene, World<float>& world, Backend<float>& backend) {
  for (std::size_t s = 0; s < scene.seeds.size(); ++s) insert(world, s, std::span<const ParticleSeed>(scene.seeds[s]));
  Motion<float> motion = initial_velocities(world, scene.seeds), spare;
  scene.seeds = {};
  backend.attach(world);
  backend.upload(world, motion, MatterFields::motion);
  form_grid(world, backend, motion, spare);
}

}  // namespace

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

double spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t last = values.size() - 1;
  return (values.at(3 * last / 4) - values.at(last / 4)) / 2 / values.at(values.size() / 2);
}

double Timing::median() const { return median_of(windows); }
double Timing::cpu_median() const { return median_of(cpu_windows); }

Course::Course(BenchScene scene, const BenchBackend& choice) {
  Stopwatch backend(make_bench_backend(choice));
  const std::optional<DeviceFacts> device = device_of(choice);
  const auto particles = static_cast<double>(scene.seeds.at(0).size());
  const double before = static_cast<double>(resident_memory_bytes()) - particles * sizeof(ParticleSeed);
  auto world = std::make_unique<World<float>>(std::move(scene.world));
  start(scene, *world, backend);
#ifdef __GLIBC__
  malloc_trim(0);  // what the start took does not count
#endif
  const bool measured = restart_peak_memory();
  for (int steps = 0; steps < least_warm_steps;) steps += period(*world, backend);
  const double grown = static_cast<double>(peak_memory_bytes()) - before;
  if (measured && grown > least_growth) memory_ = grown / particles;
  if (device) {
    const double taken = static_cast<double>(device->free) - static_cast<double>(device_of(choice)->free);
    if (taken > least_growth) device_memory_ = taken / particles;
  }
  Motion<float> unknown;  // no pass was asked for one
  backend.download(*world, unknown,
                   MatterFields::id | MatterFields::position | MatterFields::state | MatterFields::nodes);
  start_ = std::move(world);
}

Timing Course::run(const BenchBackend& choice, const Pace& pace) const {
  Stopwatch backend(make_bench_backend(choice));
  const auto particles = static_cast<double>(start_->particles());
  Timing timing;
  double total = 0;
  long long all_steps = 0;
  {
    // A copy of the world, as the backend's own data has to be warm too; its first sort then falls
    // into one window, not the median.
    World<float> world = *start_;
    backend.attach(world);
    for (int i = 0; i < 2; ++i) step<float>(world, backend, nullptr);
    backend.seconds.clear();
    backend.sorts = 0;
  }
  for (int window = 0; window < pace.windows; ++window) {
    double wall = 0, cpu = 0;
    long long steps = 0;
    while (steps == 0 || wall < pace.window_seconds) {
      World<float> world = *start_;
      backend.attach(world);
      const Moment begun;
      double now = 0;
      for (int p = 0; p < periods_per_piece && (p == 0 || wall + now < pace.window_seconds); ++p) {
        steps += period(world, backend);
        now = seconds_now() - begun.wall;
      }
      // A device may still work on what it was asked for; a sum over its nodes comes after that.
      backend.grid_momentum(world, NodesHold::momenta);
      now = seconds_now() - begun.wall;
      cpu += Moment().cpu - begun.cpu;
      wall += now;
    }
    total += wall;
    all_steps += steps;
    const double per = 1e9 / static_cast<double>(steps) / particles;
    timing.windows.push_back(wall * per);
    timing.cpu_windows.push_back(cpu * per);
    if (pace.each) pace.each(wall * per, cpu * per);
  }
  for (const auto& [stage, seconds] : backend.seconds) timing.stages[stage] = seconds / total;
  timing.steps_per_sort = static_cast<double>(all_steps) / std::max(1, backend.sorts);
  return timing;
}

double bytes_per_particle(const World<float>& w) {
  double bytes = static_cast<double>(w.grid.nodes.size() + w.grid.solids.size()) * sizeof(Node<float>) * 2;
  for (const auto& s : w.sets)
    bytes += static_cast<double>(s.size()) * (4 + 12 + 4 * static_cast<double>(s.state.size()));
  return bytes / static_cast<double>(w.particles());
}

}  // namespace dreampm
