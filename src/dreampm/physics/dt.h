// How long a step may be. Every bound is a plain number, so that each can be named as the limiter.
#pragma once
#include <cstdint>
#include <string_view>

namespace dreampm {

enum class Limiter : std::uint8_t { speed, wave, viscosity, frame, user };
constexpr std::string_view name_of(Limiter l) {
  constexpr std::string_view names[] = {"speed", "wave", "viscosity", "frame", "user"};
  return names[static_cast<int>(l)];
}

/// The explicit viscosity limit dt <= factor dx^2/nu (LIQUID: unstable from 0.3 to 0.4 in 2D; 3D has 2/3 of that).
inline constexpr double viscosity_factor = 0.15;
/// The largest cfl that scenes may ask for: in 3D the first of 120 random scenes of all materials fails at 0.72
/// (`validate stability --cfl`, docs/theory.md), and four fifths of the edge are allowed. Draws of
/// seed 5 fail from 0.51 on.
inline constexpr double largest_cfl = 0.57;
/// The wave speed is known from the step before; it may have grown since.
inline constexpr double wave_margin = 1.05;

struct StepBound {
  double dt;  ///< s
  Limiter limiter;
};

/// dt <= cfl dx/(c + v) (Courant, Friedrichs, Lewy 1928) and the viscosity limit. speed, wave: largest of any node,
/// particle [m/s]; nu: largest kinematic viscosity [m^2/s].
constexpr StepBound stable_dt(double cfl, double dx, double speed, double wave, double nu, double dt_max) {
  const double c = wave_margin * wave;
  StepBound bound{dt_max, Limiter::user};
  if (speed + c > 0 && cfl * dx / (speed + c) < bound.dt)
    bound = {cfl * dx / (speed + c), speed > c ? Limiter::speed : Limiter::wave};
  if (nu > 0 && viscosity_factor * dx * dx / nu < bound.dt)
    bound = {viscosity_factor * dx * dx / nu, Limiter::viscosity};
  return bound;
}

}  // namespace dreampm
