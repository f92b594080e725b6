// How long a step may be. Every bound is a plain number, so that each can be named as the limiter.
#pragma once
#include <cstdint>
#include <string_view>

#include "dreampm/physics/contact.h"

namespace dreampm {

enum class Limiter : std::uint8_t { speed, wave, viscosity, frame, user };
constexpr std::string_view name_of(Limiter l) {
  constexpr std::string_view names[] = {"speed", "wave", "viscosity", "frame", "user"};
  return names[static_cast<int>(l)];
}

/// The explicit viscosity limit dt <= factor dx^2/nu (LIQUID: unstable from 0.3 to 0.4 in 2D; 3D
/// has 2/3 of that).
inline constexpr double viscosity_factor = 0.15;
/// The largest cfl that scenes may ask for: four fifths of the edge, which random scenes of all
/// materials show in 3D (`validate stability --cfl`, docs/theory/step.md).
inline constexpr double largest_cfl = 0.5;
/// The wave speed is known from the step before; it may have grown since.
inline constexpr double wave_margin = 1.05;
/// The wave speed behind an impact holds in the step of the impact: that step may be longer by this
/// factor.
inline constexpr double shock_margin = 1.2;

/// The speeds and rates that bound a step, each the largest of its kind.
struct SignalSpeeds {
  double speed = 0;      ///< m/s, of nodes
  double wave = 0;       ///< m/s, of particles
  double shock = 0;      ///< m/s, of waves behind the hardest impact that `speed` allows
  double viscosity = 0;  ///< m^2/s
  int contacts = 0;      ///< how many kinds of viscous contact add to viscosity: with smooth walls, with solids
};

struct StepBound {
  double dt;  ///< s
  Limiter limiter;
};

/// dt <= cfl dx/(c + v) (Courant, Friedrichs, Lewy 1928), and as far as an impact may come.
constexpr StepBound wave_bound(double cfl, double dx, const SignalSpeeds& f) {
  const double c = wave_margin * f.wave, hit = f.shock / shock_margin;
  StepBound bound{1e30, Limiter::user};
  if (f.speed + c > 0 && cfl * dx / (f.speed + c) < bound.dt)
    bound = {cfl * dx / (f.speed + c), f.speed > c ? Limiter::speed : Limiter::wave};
  if (hit > 0 && cfl * dx / hit < bound.dt) bound = {cfl * dx / hit, Limiter::wave};
  return bound;
}

/// s: the longest step whose viscosity can be explicit.
constexpr double explicit_dt(double dx, double viscosity) {
  return viscosity > 0 ? viscosity_factor * dx * dx / viscosity : 1e30;
}

// Longer ones are sub-cycled: their forces act in stages of Runge, Kutta and Legendre (Meyer,
// Balsara and Aslam 2012, MNRAS 422:2102; RKL1, of first order), s of which are stable over (s^2 +
// s)/2 steps of Euler's with all forces that grow with viscosity, contact among them: explicit
// steps take that implicitly.

/// s: the longest of these. Euler's limit is 2 over the fastest rate, and rates add up at most.
constexpr double euler_dt(double dx, double viscosity, int contacts) {
  return explicit_dt(dx, viscosity) / (1 + 0.5 * viscosity_factor * stage_drag * contacts);
}

/// More would save next to nothing: what is left of such a step is stages.
inline constexpr int most_stages = 20;
/// The cost of a viscous stage over that of a step (docs/theory/liquid.md).
inline constexpr double stage_cost = 0.8;

constexpr double dt_of_stages(int stages, double euler_dt) { return 0.5 * stages * (stages + 1) * euler_dt; }
/// Returns the fewest stages that reach a step of dt; 0 if explicit viscosity does.
constexpr int stages_of(double dt, double dx, double viscosity, int contacts) {
  constexpr double rounding = 1 + 1e-9;
  int stages = 0;
  if (dt > explicit_dt(dx, viscosity) * rounding)
    for (stages = 2; dt > dt_of_stages(stages, euler_dt(dx, viscosity, contacts)) * rounding;) ++stages;
  return stages;
}

/// All of it, `dt_max` too: with as many stages, or none, as cost least by the second of motion;
/// none where they are not wanted. Where what is `left` of a frame ends a step it has the stages
/// that it takes: fewer that reach almost as far would be cheaper, and halve what is left again and
/// again.
constexpr StepBound stable_dt(double cfl, double dx, const SignalSpeeds& f, double left, double dt_max = 1e30,
                              bool stages = true) {
  StepBound free = wave_bound(cfl, dx, f);
  if (dt_max < free.dt) free = {dt_max, Limiter::user};
  const double limit = explicit_dt(dx, f.viscosity);
  StepBound best = free.dt > limit ? StepBound{limit, Limiter::viscosity} : free;
  double pace = limit;  // seconds of motion for what a step costs
  for (int s = 2; stages && s <= most_stages && best.dt < free.dt; ++s) {
    const double reach = dt_of_stages(s, euler_dt(dx, f.viscosity, f.contacts)), dt = reach < free.dt ? reach : free.dt;
    if (dt <= pace * (1 + stage_cost * s)) continue;
    best = {dt, dt < free.dt ? Limiter::viscosity : free.limiter};
    pace = dt / (1 + stage_cost * s);
  }
  return best.dt < left ? best : StepBound{left, Limiter::frame};
}

}  // namespace dreampm
