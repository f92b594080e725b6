// Momentum of water and rigid bodies: the momentum and angular momentum that a drop loses as it
// hits a cube are the cube's.
#include <algorithm>
#include <cmath>

#include "dreampm/backend/reductions.h"
#include "dreampm/solver/motion_by_id.h"
#include "validate/validation_run.h"

namespace dreampm::validate::cases {
namespace rigid_momentum_case {
namespace {

struct Sums {
  double mass = 0;
  Vec3d momentum{}, angular{};
  double kinetic = 0;
};

/// Returns the sums of the water and of all bodies.
template <class R>
Sums sums_of(const World<R>& world, const Balance& water) {
  Sums s{water.mass, water.momentum, water.angular, water.kinetic};
  for (const RigidBody& body : world.rigid) {
    const Collider& c = world.colliders.at(body.collider);
    const Vec3d p = c.twist.velocity * body.mass, spin = inertia_now(body, c) * c.twist.spin;
    s.mass += body.mass;
    s.momentum += p;
    s.angular += cross(c.twist.center, p) + spin;
    s.kinetic += 0.5 * (dot(p, c.twist.velocity) + dot(spin, c.twist.spin));
  }
  return s;
}

struct Hit {
  double momentum = 0, angular = 0;  ///< the largest change, of the start's
  double energy = 0;                 ///< the largest kinetic energy over the start's
  double cube = 0, spin = 0;         ///< m/s, rad/s of the cube at the end
  std::vector<double> time, drop, body;
};

template <class R>
Hit hit(Trial& t, double end, const std::vector<std::string>& overrides = {}) {
  ValidationRun<R> run(t, "rigid-momentum", overrides);
  run.begin();
  const Sums start = sums_of(run.world, balance(run.world, initial_velocities(run.world, run.seeds)));
  Hit h;
  Motion<R> motion;
  while (run.world.time < end) {
    if (!run.step(&motion).frame_done) continue;
    const Balance water = balance(run.world, motion);
    const Sums now = sums_of(run.world, water);
    h.momentum = std::max(h.momentum, length(now.momentum - start.momentum) / length(start.momentum));
    h.angular = std::max(h.angular, length(now.angular - start.angular) / length(start.angular));
    h.energy = std::max(h.energy, now.kinetic / start.kinetic);
    const Collider& cube = run.world.colliders.at(0);
    h.cube = length(cube.twist.velocity), h.spin = length(cube.twist.spin);
    h.time.push_back(run.world.time);
    h.drop.push_back(water.momentum.x), h.body.push_back(now.momentum.x - water.momentum.x);
  }
  return h;
}

template <class R>
Hit judge(Trial& t, const std::string& who, double gate, double end, const std::vector<std::string>& overrides = {}) {
  const std::string momentum = who + ": change of momentum, relative",
                    angular = who + ": change of angular momentum, relative",
                    energy = who + ": largest kinetic energy over the start's, minus 1";
  const Hit h = hit<R>(t, end, overrides);
  t.at_most(momentum, h.momentum, gate);
  t.at_most(angular, h.angular, gate);
  t.at_most(energy, h.energy - 1, 1e-6);
  t.report(who + ": speed of the cube at the end", h.cube, "m/s");
  t.report(who + ": spin of the cube at the end", h.spin, "rad/s");
  const Hit falls = hit<R>(t, 0.04, {"gravity=[1,-0.01,0]"});
  const char* const who_falls = "gravity of 1 m/s^2 along x, 0.04 s";
  t.control(who_falls, momentum, falls.momentum);
  t.control(who_falls, angular, falls.angular);
  t.control(who_falls, energy, falls.energy - 1);
  return h;
}

void run(Trial& t) {
  t.note_choice(
      "The body is a cube: its inertia is that of a ball, so that free rotation is exact. In doubles the volume of the "
      "water is not relaxed: that shifts particles, which changes their angular momentum by some millionths, with or "
      "without a body.");
  const double end = 0.3;
  const Hit fast = judge<float>(t, t.options().in_float(), 1e-5, end);
  const double shorter = t.full() ? end : 0.14;
  judge<double>(t, "reference (double), without relaxation of volume", 1e-12, shorter,
                {"materials.water.relaxation=0"});
  if (t.full()) {
    const Hit relaxed = hit<double>(t, shorter);
    t.report("reference (double), with it: change of momentum, relative", relaxed.momentum);
    t.report("reference (double), with it: change of angular momentum, relative", relaxed.angular);
  }
  std::vector<double> sum;
  for (std::size_t i = 0; i < fast.time.size(); ++i) sum.push_back(fast.drop[i] + fast.body[i]);
  t.plot({"rigid-momentum",
          "Momentum of a drop that hits a cube",
          "time  [s]",
          "momentum along x  [N s]",
          {{"water", fast.time, fast.drop}, {"cube", fast.time, fast.body}, {"sum", fast.time, sum}}});
}

}  // namespace
}  // namespace rigid_momentum_case

extern const Case rigid_momentum;
const Case rigid_momentum{"rigid-momentum",
                          "momentum and angular momentum of a drop and the rigid cube that it hits, without gravity",
                          "mechanics, exact",
                          true,
                          rigid_momentum_case::run,
                          7,
                          17};

}  // namespace dreampm::validate::cases
