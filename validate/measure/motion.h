// Motion of seeds by a field, the part of a mode in a motion, and bodies that fall and slide.
// `step` advances the world once.
#pragma once
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "dreampm/state/regroup.h"
#include "validate/measure/particles.h"

namespace dreampm::validate {

using Field = std::function<Vec3d(const Vec3d&)>;

/// Velocity and its gradient (central differences over 2 h) from a field.
inline void set_motion(ParticleSeed& n, const Field& velocity, double h) {
  n.velocity = velocity(n.position);
  for (int a = 0; a < 3; ++a) {
    Vec3d e{};
    e[a] = h;
    const Vec3d d = (velocity(n.position + e) - velocity(n.position - e)) / (2 * h);
    for (int r = 0; r < 3; ++r) n.gradient(r, a) = d[r];
  }
}

/// Returns the amplitude of a mode in the displacements since the start: sum (x - X).U(X) / sum
/// U.U. Seeds in the order of ids from 0.
template <class R>
double mode_amplitude(const World<R>& w, const std::vector<ParticleSeed>& seeds, const Field& mode) {
  const auto x = positions_by_id(w);
  double part = 0, norm = 0;
  for (const ParticleSeed& n : seeds) {
    const Vec3d u = mode(n.position);
    part += dot(x.at(n.id) - n.position, u), norm += length2(u);
  }
  return part / norm;
}

/// Returns the distance [m] of the worst particle after `steps` steps with the fixed dt from
/// symplectic Euler's fall under gravity g: x_0 + n dt v_0 + n (n + 1)/2 dt^2 g.
template <class R>
double fallen_astray(const World<R>& w, const std::vector<ParticleSeed>& seeds, int steps, const Vec3d& g) {
  const double dt = w.settings.fixed_dt;
  const auto x = positions_by_id(w);
  double worst = 0;
  for (const ParticleSeed& b : seeds)
    worst = std::max(
        worst, length(x.at(b.id) - b.position - b.velocity * (steps * dt) - g * (0.5 * steps * (steps + 1) * dt * dt)));
  return worst;
}

/// Steps `steps` times, and returns how far [m] the worst particle fell astray.
template <class R, class Step>
double fall_error(World<R>& w, const std::vector<ParticleSeed>& seeds, int steps, const Vec3d& g, const Step& step) {
  for (int i = 0; i < steps; ++i) step();
  return fallen_astray(w, seeds, steps, g);
}

/// Returns the distance [m] that matter on the floor slides along +x in `time` when gravity leans
/// by `degrees` towards it. The matter lies for as long first, damped: gravity that acts all at
/// once makes a body tremble, and friction under a wall that cannot be left sees only the pressing
/// half. Frames must end at multiples of `time`.
template <class R, class Step>
double slide(World<R>& w, double degrees, double time, const Step& step) {
  const double a = degrees * std::numbers::pi / 180, g = length(w.gravity);
  w.gravity = {0, -g * std::cos(a), 0};
  w.settings.damping = 40;
  while (w.time < time) step();
  w.settings.damping = 0;
  w.gravity.x = g * std::sin(a);
  const double start = mean_position(w).x;
  while (w.time < 2 * time) step();
  return mean_position(w).x - start;
}

}  // namespace dreampm::validate
