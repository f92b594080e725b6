#include "dreampm/solver/choose_dt.h"

#include <algorithm>
#include <cmath>

#include "dreampm/physics/materials.h"
#include "dreampm/solver/emit.h"
#include "dreampm/state/force_fields.h"

namespace dreampm {
namespace {

/// True if emitters will add matter to the set.
template <class R>
bool is_fed(const World<R>& world, const ParticleSet<R>& set) {
  return std::any_of(world.emitters.begin(), world.emitters.end(),
                     [&](const Emitter& e) { return &world.sets[e.set] == &set; });
}

/// m/s: of waves behind the hardest impact at a speed.
template <class R>
double shock_speed(const World<R>& world, double speed) {
  double fastest = 0;
  for (const ParticleSet<R>& set : world.sets)
    if (set.size() > 0 || is_fed(world, set))
      fastest = std::max(fastest, shock_wave_speed(set.material, set.values, speed));
  return fastest;
}

/// The bounds of a step that follow from matter as it is.
struct MatterBounds {
  double wave;       ///< m/s
  double viscosity;  ///< m^2/s
};
/// Returns the bounds of the last pass, and of matter at rest that comes in up to `ahead` [s] from
/// now as the first of its set: a step that was chosen before it came moves it.
template <class R>
MatterBounds matter_bounds(const World<R>& world, double ahead) {
  MatterBounds bounds{world.wave_speed, world.viscosity};
  for (const Emitter& e : world.emitters) {
    const ParticleSet<R>& set = world.sets[e.set];
    if (set.size() > 0 || !e.gives_within(world.time, world.time + ahead)) continue;
    Materials::with(set.material, [&]<class M>() {
      const MaterialFacts rest = facts_of(M::info, set.values);
      bounds.wave = std::max(bounds.wave, rest.sound_speed);
      bounds.viscosity = std::max(bounds.viscosity, rest.kinematic_viscosity);
    });
  }
  return bounds;
}

/// True if steps may be longer than explicit viscosity allows: all laws leave their viscosity to
/// sub-cycles.
template <class R>
bool may_sub_cycle(const World<R>& world) {
  bool may = world.settings.sub_cycles;
  for (const ParticleSet<R>& set : world.sets)
    Materials::with(set.material, [&]<class M>() {
      if constexpr (!Viscous<M>) may = may && facts_of(M::info, set.values).kinematic_viscosity == 0;
    });
  return may;
}

/// `rule` for the fastest that is now, nodes at `node_speed` and colliders, and that fields may
/// make within the step. `left` [s]: of the frame after the step that is now.
template <class R, class Rule>
StepBound bound_of(const World<R>& world, double node_speed, double left, const Rule& rule) {
  const double speed = std::max({node_speed * world.reach(), world.collider_speed(world.dt_next + left),
                                 emission_speed(world, world.dt_next + left)});
  const MatterBounds matter = matter_bounds(world, world.dt_next + left);
  const auto at = [&](double v) {
    return rule(SignalSpeeds{v, matter.wave, shock_speed(world, v), matter.viscosity, world.viscous_contacts()});
  };
  const StepBound bound = at(speed);
  if (world.fields.empty() || !(bound.dt > 0)) return bound;
  return at(fastest_after_fields(world, speed, bound.dt));
}

}  // namespace

template <class R>
double frame_end(const World<R>& world) {
  return world.frame / world.settings.fps;
}

template <class R>
RestOfFrame rest_of_frame(const World<R>& world, double dt) {
  const double end = frame_end(world), left = end - world.time - dt, next_end = (world.frame + 1) / world.settings.fps;
  const bool done = left <= 1e-6 * dt;
  return {done, done ? next_end - end : left};
}

template <class R>
void split_frame(World<R>& world, const StepBound& bound, double left) {
  const double steps = std::max(1.0, std::ceil(left / bound.dt * (1 - 1e-9)));
  world.dt_next = left / steps;
  world.dt_limiter = steps == 1 ? Limiter::frame : bound.limiter;
}

template <class R>
void advance_clock(World<R>& world, double dt, bool frame_done) {
  ++world.step;
  world.time = frame_done ? frame_end(world) : world.time + dt;
  if (frame_done) ++world.frame;
}

template <class R>
void choose_dt(World<R>& world, double node_speed, double left) {
  const StepSettings& s = world.settings;
  const bool stages = may_sub_cycle(world);
  StepBound bound{s.fixed_dt, Limiter::user};
  if (!(s.fixed_dt > 0))
    bound = bound_of(world, node_speed, left,
                     [&](const SignalSpeeds& f) { return stable_dt(s.cfl, world.dx, f, left, s.dt_max, stages); });
  split_frame(world, bound, left);
  const double viscosity = matter_bounds(world, left).viscosity;
  world.viscous_stages = stages ? stages_of(world.dt_next, world.dx, viscosity, world.viscous_contacts()) : 0;
}

template <class R>
double longest_stable_dt(const World<R>& world, double node_speed) {
  const bool stages = may_sub_cycle(world);
  const StepBound bound = bound_of(world, node_speed, 1 / world.settings.fps, [&](const SignalSpeeds& f) {
    return stages ? wave_bound(largest_cfl, world.dx, f) : stable_dt(largest_cfl, world.dx, f, 1e30, 1e30, false);
  });
  return bound.dt;
}

template <class R>
bool step_suits(const World<R>& world, double speed) {
  // Particles of a projection go through a grid that reaches a block further than they do.
  if (world.settings.solver == SolverKind::projection) return speed * world.dt_next <= block_width * world.dx;
  const SignalSpeeds signals{speed * world.reach(), world.wave_speed, shock_speed(world, speed), 0, 0};
  return world.dt_next <= wave_bound(largest_cfl, world.dx, signals).dt;
}

#define DM_INSTANTIATE(R)                                         \
  template double frame_end(const World<R>&);                     \
  template RestOfFrame rest_of_frame(const World<R>&, double);    \
  template void split_frame(World<R>&, const StepBound&, double); \
  template void advance_clock(World<R>&, double, bool);           \
  template void choose_dt(World<R>&, double, double);             \
  template double longest_stable_dt(const World<R>&, double);     \
  template bool step_suits(const World<R>&, double);
DM_INSTANTIATE(float)
DM_INSTANTIATE(double)
#undef DM_INSTANTIATE

}  // namespace dreampm
