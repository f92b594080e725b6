#include "validate/bar.h"

#include <cmath>
#include <numbers>

#include "dreampm/physics/materials.h"
#include "validate/measure/motion.h"

namespace dreampm::validate {
namespace {

constexpr double a = 0.01, k = std::numbers::pi;  // amplitude [m]; wave number of a bar of 1 m

/// The wave speed of the scene's one material in its rest state [m/s], from its own law.
double sound_speed(const model::Scene& scene) {
  const model::Material& m = scene.materials.at(0);
  double speed = 0;
  Materials::with(m.type, [&]<class M>() {
    typename M::template State<double> rest;
    for (int c = 0; c < state_columns<M>; ++c) rest[c] = M::template State<double>::rest[c];
    speed = M::template Law<double>::from(m.values).respond(rest).sound_speed;
  });
  return speed;
}

}  // namespace

Curve BarWave::exact() const {
  Curve c{"exact", {}, {}, true};
  for (double t = 0; t < 3; t += 0.05) c.x.push_back(t), c.y.push_back(std::sin(2 * std::numbers::pi * t));
  return c;
}

BarWave ring_bar(Trial& trial, const std::string& scene, int cells, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = overrides;
  all.push_back(fmt::format("space.spacing={:.17g}", 0.5 / cells));
  ValidationRun<float> run(trial, scene, all);
  const double omega = k * sound_speed(built_in_scene(scene)), period = 2 * std::numbers::pi / omega;
  const Field mode = [](const Vec3d& p) { return Vec3d{std::sin(k * p.x), 0, 0}; };
  const Field start = [&](const Vec3d& p) { return mode(p) * (a * omega); };
  for (ParticleSeed& n : run.seeds[0]) set_motion(n, start, 1e-5);
  run.begin();
  // Started at its middle by its velocity: q(t) = A sin(omega t).
  BarWave r;
  const auto seeds = run.all_seeds();
  r.swing.add(0, 0);
  run.until(3 * period, [&](const StepSums&) {
    const double q = mode_amplitude(run.world, seeds, mode) / a, t = run.world.time / period;
    r.swing.add(t, q);
    r.worst = std::max(r.worst, std::abs(q - std::sin(2 * std::numbers::pi * t)));
  });
  r.period = r.swing.period();
  r.amplitude = r.swing.extreme(3);
  return r;
}

}  // namespace dreampm::validate
