#include "bench/taps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "bench/bench_mesh.h"
#include "bench/moment.h"
#include "bench/scenes.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"
#include "dreampm/geometry/mesh.h"
#include "dreampm/level_set/level_set.h"
#include "dreampm/physics/materials.h"
#include "dreampm/physics/projection/time_step.h"

namespace dreampm {
namespace {

/// Two sorts of a column that nothing disturbs, and five of one with a sink.
constexpr int explicit_steps = 40, large_steps = 8;
/// s: a cell at the speed of the tap is a step of the projection.
constexpr double large_step = 0.01;
constexpr double tap_speed = 2;  ///< m/s
constexpr int rotor_faces = 4512;
constexpr double rotor_speed = 1;  ///< m/s, of its rim

std::shared_ptr<const Region> box(const Vec3d& low, const Vec3d& high) {
  Shape shape;
  shape.form = BoxShape{high - low}, shape.center = (low + high) * 0.5;
  return make_region(shape, bench_dx, {});
}

/// The measures by which taps are placed: the matter reaches from 0 to `size`, the box up to `top`
/// [m].
struct Room {
  Vec3d size;
  double top, reach;  ///< reach: half the width of a tap
};

void add_tap(BenchScene& scene, const Room& room) {
  World<float>& w = scene.world;
  Emitter tap;
  tap.name = "tap";
  const Vec3d middle{0.5 * room.size.x, room.top - 2 * w.dx, 0.5 * room.size.z},
      half{room.reach, 0.75 * w.dx, room.reach};
  tap.shape = box(middle - half, middle + half);
  tap.speed = {{0, tap_speed}};
  tap.pool = 1 << 17;
  w.emitters.push_back(std::move(tap));
  w.next_id = static_cast<std::uint32_t>(scene.seeds[0].size());
}

void add_drain(BenchScene& scene, const Room& room) {
  const Vec3d middle{0.5 * room.size.x, 0, 0.5 * room.size.z}, half{room.reach, 2 * scene.world.dx, room.reach};
  scene.world.sinks.push_back({"drain", box(middle - half, middle + half)});
}

void add_rotor(BenchScene& scene, const Room& room) {
  World<float>& w = scene.world;
  const Vec3d middle{0.5 * room.size.x, 0.4 * room.size.y, 0.5 * room.size.z};
  const double radius = 0.35 * std::min({room.size.x, room.size.y, room.size.z});
  Collider rotor;
  rotor.name = "rotor";
  rotor.shape = mesh_region(lobed_ball(middle, radius, rotor_faces), 0.5 * w.dx, rotor.name);
  rotor.twist = {{}, {0, rotor_speed / radius, 0}, middle};
  std::erase_if(scene.seeds[0], [&](const ParticleSeed& s) { return rotor.distance(s.position) < 0.25 * w.dx; });
  w.colliders.push_back(std::move(rotor));
}

BenchScene scene_of(const StepBenchOptions& options, Tap tap) {
  const MaterialInfo& material = bench_material(options.material);
  const Vec3i cells = options.cells.value_or(column_cells(options.particles));
  BenchScene scene = options.large_steps ? tank_scene(material, cells) : column_scene(material, cells);
  World<float>& w = scene.world;
  if (options.large_steps) {
    w.settings.solver = SolverKind::projection, w.settings.cfl = usual_projection_cfl;
    w.settings.fixed_dt = large_step;
    w.sets[0].carries_motion = true;
  }
  const Room room{static_cast<Vec3d>(cells) * w.dx, w.domain().max.y,
                  std::min(4.0, 0.25 * std::min(cells.x, cells.z)) * w.dx};
  if (tap == Tap::emitter) add_tap(scene, room);
  if (tap == Tap::sink) add_drain(scene, room);
  if (tap == Tap::moving) add_rotor(scene, room);
  return scene;
}

struct TapText {
  const char *alone, *with, *share;
};
TapText text_of(Tap tap) {
  switch (tap) {
    case Tap::emitter:
      return {"alone", "with an emitter", "an emitter"};
    case Tap::sink:
      return {"alone", "with a sink", "a sink"};
    case Tap::moving:
      return {"with a mesh that stands", "with a mesh that turns", "its turning"};
    case Tap::edit:
      return {"alone", "with an edit before each", "an edit"};
  }
  fail_run("no such tap");
}

}  // namespace

TappedSteps::TappedSteps(const StepBenchOptions& options, Tap tap, const BenchBackend& choice)
    : tap_(tap), steps_per_piece_(options.large_steps ? large_steps : explicit_steps) {
  BenchScene scene = scene_of(options, tap);
  engine_ = std::make_unique<Engine<float>>(std::move(scene.world), make_bench_backend(choice));
  engine_->begin(scene.seeds);
  scene.seeds = {};
  for (int n = 0; n < steps_per_piece_; ++n) step();
  engine_->download(MatterFields::all);
  start_ = std::make_unique<const World<float>>(engine_->world());
}

TappedSteps TappedSteps::without_tap(const BenchBackend& choice) const {
  TappedSteps other;
  other.steps_per_piece_ = steps_per_piece_;
  auto start = std::make_unique<World<float>>(*start_);
  start->emitters.clear(), start->sinks.clear();
  for (Collider& c : start->colliders) c.twist = {};
  other.start_ = std::move(start);
  other.engine_ = std::make_unique<Engine<float>>(World<float>(*other.start_), make_bench_backend(choice));
  return other;
}

void TappedSteps::step() {
  if (tap_ != Tap::edit) {
    engine_->step();
    return;
  }
  if (engine_->motion_is_current()) {
    Values& values = engine_->world().sets[0].values;
    values.set("density", values["density"] * (grows_ ? 1.001 : 1 / 1.001));
    grows_ = !grows_;
    engine_->form_grid();
  }
  engine_->step(always);
}

void TappedSteps::run_window(double seconds, Timing& timing) {
  double wall = 0, cpu = 0, particle_steps = 0;
  while (particle_steps == 0 || wall < seconds) {
    engine_->replace(World<float>(*start_), nullptr);
    step();  // arrays become warm, and velocities known
    const Moment begun;
    for (int n = 0; n < steps_per_piece_; ++n) {
      step();
      particle_steps += static_cast<double>(engine_->world().particles());
    }
    const Moment end;
    wall += end.wall - begun.wall, cpu += end.cpu - begun.cpu;
  }
  timing.windows.push_back(1e9 * wall / particle_steps);
  timing.cpu_windows.push_back(1e9 * cpu / particle_steps);
}

std::vector<BenchRow> bench_taps(const StepBenchOptions& options, const std::vector<Tap>& taps) {
  if (options.droplets) fail_input("--droplets: taps are measured beside a column; leave it out");
  bench_material(options.material), check_particles(options.particles);
  if (options.large_steps && options.material != "newtonian")
    fail_input("--solver projection: moves water; leave --material out");
  const ThreadLimit threads(options.threads);
  if (options.large_steps && !options.backend.on_host())
    fail_input("--solver projection: it computes on processors; leave --backend {} out", options.backend.backend);
  const std::string isa(make_bench_backend(options.backend)->isa()),
      solver = options.large_steps ? "projection" : "steps";
  std::vector<BenchRow> rows;
  for (const Tap tap : taps) {
    TappedSteps with(options, tap, options.backend), alone = with.without_tap(options.backend);
    Timing first, second;
    std::vector<double> shares, cpu_shares;
    for (int window = 0; window < options.windows; ++window) {
      alone.run_window(options.window_seconds, first);
      with.run_window(options.window_seconds, second);
      if (options.each)
        for (const Timing* t : {&first, &second}) options.each(t->windows.back(), t->cpu_windows.back());
      shares.push_back(100 * (second.fair(options.threads).back() / first.fair(options.threads).back() - 1));
      cpu_shares.push_back(100 * (second.cpu_windows.back() / first.cpu_windows.back() - 1));
    }
    const TapText text = text_of(tap);
    const auto add = [&](const TappedSteps& steps, const char* what, const Timing& timing) {
      const double ns = median_of(timing.fair(options.threads));
      rows.push_back({fmt::format("{} {}", solver, what), steps.particles(), isa, options.threads, 1e3 / ns, "M/s",
                      spread_of(timing.fair(options.threads)), fmt::format("{:.1f} ns", ns), options.backend.backend});
    };
    add(alone, text.alone, first);
    add(with, text.with, second);
    rows.push_back({fmt::format("{}: cost of {}", solver, text.share), with.particles(), isa, options.threads,
                    median_of(shares), "%", 0,
                    fmt::format("of the step; {:.1f} % of processor time", median_of(cpu_shares)),
                    options.backend.backend});
  }
  return rows;
}

}  // namespace dreampm
