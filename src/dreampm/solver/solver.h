// How a world goes on from step to step: by explicit steps over a backend, or by a projection.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "dreampm/backend/backend.h"
#include "dreampm/rigid/rigid_motion.h"
#include "dreampm/solver/step_accounting.h"

namespace dreampm {

template <class R>
class Solver {
 public:
  virtual ~Solver() = default;
  /// Another world goes on, of a copy or a checkpoint, with its motion, if that is known.
  virtual void attach(const World<R>& world, const Motion<R>* motion) = 0;
  /// Brings the first matter into an empty world, seeds[s] into set s, and chooses the first step.
  /// Ids must be unique within the world. Throws NumericalFailure.
  virtual void begin(World<R>& world, const std::vector<std::vector<ParticleSeed>>& seeds) = 0;
  /// Brings new matter in between steps, at rest state. Changes the order of particles.
  virtual PassStats insert(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) = 0;
  /// One step of world.dt_next. `motion` is filled in a step that ends a frame and in one that ends
  /// at `next_sample_time` [s] or later. `contacts`: impacts of rigid bodies, or null. Throws
  /// NumericalFailure; the world is then lost.
  virtual StepSums step(World<R>& world, Motion<R>& motion, double next_sample_time, BodyContacts* contacts) = 0;
  /// Must be called after edits of the world, and of `motion` with it: chooses anew what the coming
  /// step needs.
  virtual void form_grid(World<R>& world, Motion<R>& motion) = 0;
};

/// Makes the solver of world.settings.solver. `backend` must outlive it.
template <class R>
std::unique_ptr<Solver<R>> make_solver(const World<R>& world, Backend<R>& backend);

}  // namespace dreampm
