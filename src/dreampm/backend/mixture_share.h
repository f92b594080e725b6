// The share of one particle in the mixture of nodes.
#pragma once
#include "dreampm/physics/particle.h"
#include "dreampm/state/world.h"

namespace dreampm {

/// The share of a particle in the mixture (state/grid.h): the volume that it fills and its
/// viscosity if it is liquid, else the volume that it blocks.
template <class R>
class MixtureShare {
 public:
  /// `viscosity` [m^2/s] and `volume_ratio` J [1] are those of the particle.
  MixtureShare(const World<R>& world, const ParticleSet<R>& set, const SetStep<R>& step, R viscosity, R volume_ratio)
      : field_(world.field_of(set)),
        liquid_(set.liquid),
        volume_(static_cast<R>(set.rest_volume / (world.dx * world.dx * world.dx))),
        mass_(step.mass),
        viscosity_(viscosity),
        volume_ratio_(volume_ratio) {}

  /// Adds the share of weight `w` to a node.
  void add_to(Node<R>& node, R w) const {
    mixture::filled(node, field_) += w * volume_;
    if (liquid_)
      mixture::viscosity(node) += w * mass_ * viscosity_;
    else
      mixture::blocked(node) += w * volume_ * volume_ratio_;
  }

 private:
  std::size_t field_;
  bool liquid_;
  R volume_;  ///< at rest, over dx^3 [1]
  R mass_, viscosity_, volume_ratio_;
};

}  // namespace dreampm
