// Two presets of the program that asked for this project, step by step against a scalar double port
// of its algorithm.
#include "validate/measure/seed.h"

#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace seed_case {
namespace {

template <class R>
SeedErrors errors(Trial& t, bool elastic, int steps, const std::vector<std::string>& overrides = {}) {
  ValidationRun<R> run(t, elastic ? "seed-elastic" : "seed-snow", overrides);
  run.world.settings.keep_inside = false;  // the port has no such clamp
  // The port numbers its particles with z running fastest.
  auto& all = run.seeds[0];
  std::sort(all.begin(), all.end(), [](const ParticleSeed& a, const ParticleSeed& b) {
    const Vec3d d = b.position - a.position;
    constexpr double same = 1e-3;  // m; the lattice has 1/64
    return std::abs(d.x) > same ? d.x > 0 : std::abs(d.y) > same ? d.y > 0 : d.z > same;
  });
  for (std::size_t i = 0; i < all.size(); ++i) all[i].id = static_cast<std::uint32_t>(i);
  run.begin();
  const std::string stem = elastic ? "seed_dreampm_1_elastic_" : "seed_dreampm_0_snow_";
  return seed_errors(run.world, reference_table(stem + "timeseries.csv"), reference_table(stem + "state_step1500.csv"),
                     steps, [&] { run.step(); });
}

Curve curve(std::string name, const SeedErrors& e) {
  Curve c{std::move(name), e.time, {}};
  for (const double d : e.distance) c.y.push_back(std::log10(std::max(d, 1e-17)));
  return c;
}

void run(Trial& t) {
  Plot plot{"seed", "Distance from the port's trajectories", "time  [s]", "log10 of the distance [m]", {}};
  for (const bool elastic : {false, true}) {
    const std::string name = elastic ? "elastic" : "snow";
    const int steps = elastic && !t.full() ? 1500 : 2000;
    const SeedErrors exact = errors<double>(t, elastic, steps), fast = errors<float>(t, elastic, steps);
    const std::string before = name + ", reference (double): before contact",
                      after = name + ", reference (double): after contact",
                      state = name + ", reference (double): worst particle at step 1500",
                      rms = name + ", " + t.options().in_float() + ": rms from the double run at the end";
    t.at_most(before, exact.before, 1e-9, "m");
    t.at_most(after, exact.after, 1e-6, "m");
    t.at_most(state, exact.state_max, 1e-6, "m");
    t.at_most(rms, rms_distance(fast.last, exact.last), 1e-4, "m");
    const SeedErrors light = errors<float>(t, elastic, steps, {"gravity=[0,-9.7,0]"});
    const char* const what = "gravity 9.7 for 9.8";
    t.control(what, before, light.before);
    t.control(what, after, light.after);
    t.control(what, state, light.state_max);
    if (elastic) t.control(what, rms, rms_distance(light.last, exact.last));
    t.report(name + ", " + t.options().in_float() + ": rms from the port at step 1500", fast.state_rms, "m");
    plot.curves.push_back(curve(name + ", double", exact));
    plot.curves.push_back(curve(name + ", float", fast));
    if (!elastic)
      t.control("hardening by this step's Jp", rms,
                rms_distance(errors<float>(t, false, 2000, {"materials.cube.legacy=false"}).last, exact.last));
  }
  t.plot(std::move(plot));
}

}  // namespace
}  // namespace seed_case

extern const Case seed;
const Case seed{"seed",
                "the snow-like and the elastic preset of the original program, 2,000 steps, through impact",
                "an independent scalar double port of its algorithm: seed_dreampm_*.csv",
                true,
                seed_case::run,
                15,
                7};

}  // namespace dreampm::validate::cases
