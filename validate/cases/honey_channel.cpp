// A very viscous liquid starts to flow between two plates that it sticks to, pulled along them by
// gravity, in steps far beyond what explicit viscosity allows: Navier-Stokes, exact.
//   u = g/(2 nu) y (H - y) - sum over odd n of 4 g H^2/(nu pi^3 n^3) sin(n pi y/H) exp(-n^2 pi^2 nu t/H^2)
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "validate/measure/particles.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace honey_channel_case {
namespace {

constexpr double pi = std::numbers::pi, g = 9.81, gap = 0.1, nu = 0.28, density = 1000, area = 0.05 * 0.05;
constexpr double tau = gap * gap / (pi * pi * nu), fastest = g * gap * gap / (8 * nu);
constexpr double starting[] = {0.3, 1, 3, 8}, steady[] = {56};  // times tau: looks

double speed(double y, double t) {
  double u = g / (2 * nu) * y * (gap - y);
  for (int n = 1; n < 100; n += 2)
    u -= 4 * g * gap * gap / (nu * pi * pi * pi * n * n * n) * std::sin(n * pi * y / gap) * std::exp(-n * n * t / tau);
  return u;
}

/// N, of both plates: 2 mu du/dy at one.
double drag(double t) {
  double slope = g * gap / (2 * nu);
  for (int n = 1; n < 400; n += 2) slope -= 4 * g * gap / (nu * pi * pi * n * n) * std::exp(-n * n * t / tau);
  return 2 * density * nu * slope * area;
}

/// J that viscosity makes between two times: what gravity does, less what stays in motion.
double heat(double from, double to) {
  constexpr int parts = 200;
  const auto across = [](const auto& f) {
    double sum = 0;
    for (int i = 0; i < parts; ++i) sum += f((i + 0.5) * gap / parts) * gap / parts;
    return density * area * sum;
  };
  const auto kinetic = [&](double t) { return across([t](double y) { return 0.5 * speed(y, t) * speed(y, t); }); };
  double work = 0;
  for (int i = 0; i < parts; ++i) {
    const double t = from + (i + 0.5) * (to - from) / parts;
    work += across([t](double y) { return g * speed(y, t); }) * (to - from) / parts;
  }
  return work - (kinetic(to) - kinetic(from));
}

struct Flow {
  double error = 0;  ///< rms over particles at the worst of the looks, of the fastest steady speed
  double drag = 0;   ///< of the plates at the last look, over the exact one
  double heat = 0;   ///< between the last two looks, over the exact one
  int stages = 0;
  std::uint64_t steps = 0;
};

Flow flow_of(Trial& t, const std::vector<std::string>& overrides = {}, Plot* plot = nullptr,
             std::span<const double> looks = starting) {
  ValidationRun<float> run(t, "honey-channel", overrides);
  run.begin();
  Flow flow;
  Motion<float> motion;
  double start = 0;
  for (const double look : looks) {
    double made = 0, pull = 0;
    start = run.world.time;
    while (run.world.time < look * tau) {
      flow.stages = std::max(flow.stages, run.world.viscous_stages);
      const StepSums r = run.step(&motion, look * tau);
      ++flow.steps;
      made += r.pass.energy.viscous;
      pull = -(r.grid.walls[2].impulse.x + r.grid.walls[3].impulse.x) / r.dt;
    }
    const double now = run.world.time;
    flow.drag = pull / drag(now), flow.heat = made / heat(start, now);
    double sum = 0;
    std::vector<std::pair<double, double>> profile;
    each_particle(run.world, [&](std::size_t s, std::size_t p, const Vec3d& at) {
      const double u = static_cast<double>(motion.sets[s].velocity[p].x), off = u - speed(at.y, now);
      sum += off * off;
      profile.emplace_back(at.y / gap, u / fastest);
    });
    flow.error = std::max(flow.error, std::sqrt(sum / static_cast<double>(profile.size())) / fastest);
    if (!plot) continue;
    std::sort(profile.begin(), profile.end());
    Curve ours{fmt::format("t = {:.2g} H^2/(pi^2 nu)", look), {}, {}}, series{"exact", {}, {}, true};
    for (std::size_t i = 0; i < profile.size(); i += profile.size() / 64)
      ours.x.push_back(profile[i].first), ours.y.push_back(profile[i].second);
    for (int i = 0; i <= 20; ++i) series.x.push_back(i / 20.0), series.y.push_back(speed(gap * i / 20, now) / fastest);
    plot->curves.push_back(std::move(ours)), plot->curves.push_back(std::move(series));
  }
  return flow;
}

void run(Trial& t) {
  t.note_choice(
      "280 Pa s, 33 times honey, so that the limit of explicit viscosity is far below that of sound; 16 cells from "
      "plate to plate. Walls mirror the matter before them, the other axes have no end.");
  Plot plot{
      "honey-channel", "Start of a viscous flow between plates", "place between the plates", "speed / fastest", {}};
  const Flow flow = flow_of(t, {}, &plot);
  const std::string stages = "stages of viscosity in a step";
  t.at_least(stages, flow.stages, 5);
  const std::string profile = "error of the profile, of the fastest speed",
                    pull = "drag of the plates over the exact, minus 1",
                    warmth = "heat of viscosity over the exact, minus 1";
  t.at_most(profile, flow.error, 0.01, "%");
  t.at_most(pull, std::abs(flow.drag - 1), 0.01, "%");
  t.at_most(warmth, std::abs(flow.heat - 1), 0.02, "%");
  // Steps short enough that nothing is left to stages.
  const Flow fine = flow_of(t, {"time.dt=2.0e-5"});
  t.report("the same with explicit viscosity: error of the profile", fine.error, "%");
  t.report("the same with explicit viscosity: steps over ours",
           static_cast<double>(fine.steps) / static_cast<double>(flow.steps));
  t.control("steps of 20 microseconds", stages, fine.stages);
  const Flow thick = flow_of(t, {"materials.liquid.viscosity=288.4"});
  t.control("3 % more viscosity", profile, thick.error);
  t.control("3 % more viscosity, by its heat", warmth, std::abs(thick.heat - 1));
  t.control("plates that it slips along", pull, std::abs(flow_of(t, {"space.walls.floor.type=slip"}).drag - 1));
  t.plot(std::move(plot));
}

void run_projection(Trial& t) {
  t.note_choice(
      "280 Pa s, 33 times honey; 16 cells from plate to plate. Once in steps as long as frames, 1.4 H^2/(pi^2 nu), "
      "until the flow is steady; then in steps of a hundredth of those, through its start. What gravity gives in a "
      "long "
      "step is more than the flow is fast, and its heat counts from there: it is judged in short ones.");
  Plot plot{"honey-channel-projection",
            "Start of a viscous flow between plates, by the projection",
            "place between the plates",
            "speed / fastest",
            {}};
  const auto by = [](const char* dt, std::vector<std::string> more = {}) {
    more.push_back(std::string("time.dt=") + dt);
    return by_projection("liquid", more);
  };
  const char *const frame = "5.0e-3", *const part = "5.0e-5";
  const Flow small = flow_of(t, by(part), &plot), large = flow_of(t, by(frame), &plot, steady);
  const char *const end = "steps of 5 ms: error of the steady profile, of the fastest speed",
                    *const start = "steps of 0.05 ms: error of the profile, of the fastest speed",
                    *const warmth = "steps of 0.05 ms: heat of viscosity over the exact, minus 1",
                    *const pull = "steps of 5 ms: drag of the plates over the exact, minus 1",
                    *const first_pull = "steps of 0.05 ms: drag of the plates over the exact, minus 1";
  t.at_most(end, large.error, 0.01, "%");
  t.at_most(pull, std::abs(large.drag - 1), 0.01, "%");
  t.report("steps of 5 ms", static_cast<double>(large.steps));
  t.at_most(start, small.error, 0.01, "%");
  t.at_most(warmth, std::abs(small.heat - 1), 0.02, "%");
  t.at_most(first_pull, std::abs(small.drag - 1), 0.02, "%");
  t.report("steps of 0.05 ms", static_cast<double>(small.steps));
  const std::vector<std::string> thin{"materials.liquid.viscosity=271.6"};
  t.control("3 % less viscosity", end, flow_of(t, by(frame, thin), nullptr, steady).error);
  const Flow along =
      flow_of(t, by(frame, {"space.walls.floor.type=slip", "space.walls.ceiling.type=slip"}), nullptr, steady);
  t.control("plates that it slips along", pull, std::abs(along.drag - 1));
  t.control("plates that it slips along", first_pull, std::abs(along.drag - 1));
  const Flow fast = flow_of(t, by(part, thin));
  t.control("3 % less viscosity", start, fast.error), t.control("3 % less viscosity", warmth, std::abs(fast.heat - 1));
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace honey_channel_case

extern const Case honey_channel;
const Case honey_channel{"honey-channel",
                         "a very viscous liquid starts to flow between two plates, its viscosity sub-cycled",
                         "Navier-Stokes, exact: the start of plane Poiseuille flow",
                         true,
                         honey_channel_case::run,
                         5,
                         5};

extern const Case honey_channel_projection;
const Case honey_channel_projection{
    "honey-channel-projection",
    "a very viscous liquid starts to flow between two plates by the projection, in long steps and in short ones",
    honey_channel.source,
    true,
    honey_channel_case::run_projection,
    5};

}  // namespace dreampm::validate::cases
