#include "bench/frame_cost.h"

#include <chrono>
#include <filesystem>

#include "bench/temporary_folder.h"
#include "dreampm/base/file.h"
#include "dreampm/base/parallel.h"
#include "dreampm/pictures/frames.h"
#include "dreampm/run/ledger_row.h"
#include "dreampm/run/probe_set.h"
#include "dreampm/run/probe_writer.h"

namespace dreampm {
namespace {
namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;
template <class F>
double seconds_of(const F& f) {
  const auto start = Clock::now();
  f();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The world without its particles, as probes want to see it before the start.
InitialState start_of(const World<float>& world) {
  InitialState start;
  World<double>& empty_world = start.world;
  empty_world.dx = world.dx, empty_world.low = world.low, empty_world.high = world.high;
  empty_world.origin = world.origin, empty_world.gravity = world.gravity;
  for (const auto& set : world.sets) {
    ParticleSet<double> empty;
    empty.name = set.name, empty.material = set.material, empty.values = set.values, empty.liquid = set.liquid;
    empty.mass = set.mass, empty.rest_volume = set.rest_volume;
    empty_world.sets.push_back(std::move(empty));
  }
  start.seeds.resize(world.sets.size());
  return start;
}

/// A surface height, a wall's pressure and a wall's force: what a dam break asks for.
model::Scene probed(const World<float>& world) {
  model::Scene scene;
  scene.space.spacing = world.dx / 2;
  const Vec3d far = world.node_position(world.high);
  scene.probes.push_back({"height", 0, HeightProbe{far.x / 4, far.z / 2}});
  PressureProbe pressure;
  pressure.at = {far.x / 4, 0, far.z / 2}, pressure.normal = {0, 1, 0}, pressure.radius = 2 * world.dx;
  scene.probes.push_back({"pressure", 0, pressure});
  ForceProbe force;
  force.on = "floor";
  scene.probes.push_back({"force", 0, force});
  return scene;
}

}  // namespace

FrameCost frame_cost(const Course& course, const BenchBackend& choice, int tries) {
  const auto backend = make_bench_backend(choice);
  World<float> world = course.world();
  backend->attach(world);
  const TemporaryFolder folder;
  const model::Scene scene = probed(world);
  const InitialState start = start_of(world);
  ProbeSet<float> probes(scene, start, scene.name);
  std::vector<ProbeColumns> columns;
  for (std::size_t p = 0; p < probes.size(); ++p) columns.push_back({probes.name(p), probes.columns(p)});
  ProbeWriter probe_files(columns, folder.path / "probes");
  probe_files.begin();
  LedgerWriter ledger(folder.path / "ledger.csv", ledger_kind(world));
  const std::vector<BodyRange> bodies{{"all", 0, static_cast<std::uint32_t>(world.particles()), std::nullopt}};
  Motion<float> motion;
  std::optional<LedgerRow> last;
  std::vector<double> plain, output;
  double heaviest = 0;
  for (const auto& set : world.sets) heaviest = std::max(heaviest, set.mass);
  for (int frame = 0; frame <= tries; ++frame) {
    FrameSums sums;
    const double without = seconds_of([&] { sums.add(step<float>(world, *backend, nullptr), heaviest); });
    const double with = seconds_of([&] {
      const StepSums report = step<float>(world, *backend, &motion, 0);
      sums.add(report, heaviest);
      probes.accumulate(report);
    });
    const double writing = seconds_of([&] {
      backend->download(world, motion, MatterFields::all);
      write_particles(folder.path / "particles.ply", particle_frame(world, motion, bodies, {"velocity"}, {}));
      LedgerRow row = ledger_row(world, *backend, motion, sums, last ? &*last : nullptr);
      row.frame = frame + 1;
      ledger.append(row);
      last = std::move(row);
      probes.sample(world, motion, true, [&](std::size_t p, const std::vector<double>& numbers) {
        probe_files.append(p, world.time, numbers);
      });
      state_hash(world);
    });
    if (frame == 0) continue;  // warms the arrays of motions
    plain.push_back(without);
    output.push_back(std::max(0.0, with - without) + writing);
  }
  return {median_of(plain), median_of(output)};
}

BenchRow frame_row(const Course& course, const BenchBackend& choice, const std::string& isa) {
  // The dragon at full resolution: dx 6 mm, c + v = 49 m/s, cfl 1/2, 24 frames a second.
  constexpr double steps = 49 / (0.5 * 0.006) / 24;
  const FrameCost cost = frame_cost(course, choice, 3);
  return {"output, ledger and probes in a frame of the dragon",
          course.world().particles(),
          isa,
          thread_count(),
          100 * cost.output / (cost.output + steps * cost.step),
          "%",
          0,
          fmt::format("{:.3g} s beside {:.0f} steps of {:.2g} s", cost.output, steps, cost.step),
          choice.backend};
}

}  // namespace dreampm
