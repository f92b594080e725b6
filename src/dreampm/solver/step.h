// THE step, and its beginning.
#pragma once
#include <limits>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/base/error.h"
#include "dreampm/rigid/rigid_motion.h"
#include "dreampm/solver/step_accounting.h"

namespace dreampm {

/// Brings the first matter into an empty world, seeds[s] into set s, and chooses the first step.
/// The backend keeps nothing of a world that it ran before. Ids must be unique within the world.
/// Throws NumericalFailure.
template <class R>
void begin(World<R>& world, Backend<R>& backend, const std::vector<std::vector<ParticleSeed>>& seeds);

/// s: how long steps of a fixed dt may be after `begin` with these seeds: what the largest cfl of
/// scenes allows. Viscosity does not count where it is sub-cycled.
template <class R>
double longest_fixed_dt(const World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds);

/// One step of world.dt_next:  grid_update -> sub_cycle, where viscosity needs it -> choose the
/// next dt -> sort if due -> g2p2g -> advance the clock. `motion` is filled, if not null, in the
/// pass that ends a frame and in one that ends at `next_sample_time` [s] or later. `contacts`:
/// impacts of rigid bodies, or null. Throws NumericalFailure; the world is then lost.
template <class R>
StepSums step(World<R>& world, Backend<R>& backend, Motion<R>* motion,
              double next_sample_time = std::numeric_limits<double>::infinity(), BodyContacts* contacts = nullptr);

}  // namespace dreampm
