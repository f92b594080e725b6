// The grid formed from particles as they stand: at the start, and after an edit.
#pragma once
#include "dreampm/backend/backend.h"
#include "dreampm/backend/mixture_share.h"
#include "dreampm/contact/obstacles.h"
#include "dreampm/physics/particle.h"

namespace dreampm {

/// The terms that a particle adds to the grid, x_i - x_p in cells.
template <class R>
struct ParticleTerms {
  Vec3<R> momentum;       ///< m v
  Vec3<R> affine[3];      ///< slopes of momentum, m C
  Vec3<R> stress[3]{};    ///< slopes that the stress gives in the step to come
  R viscosity = R(0);     ///< m^2/s
  R volume_ratio = R(1);  ///< J
};

/// Nodes that a set adds to, a field by its first node; null where it adds to none.
template <class R, class N = Node<R>>
struct NodesToAddTo {
  N* own = nullptr;            ///< momentum and mass
  N* stress = nullptr;         ///< see GridFields
  N* velocity_old = nullptr;   ///< see GridFields
  Node<R>* mixture = nullptr;  ///< see namespace mixture
};
template <class R>
NodesToAddTo<R> nodes_to_add_to(World<R>& world, const ParticleSet<R>& set) {
  const std::size_t number = world.field_of(set);
  const auto first = [](Nodes<R>& field) { return field.empty() ? nullptr : field.data(); };
  return {first(world.grid.field(number)), first(world.grid.stress[number]),
          set.transfer.keeps_velocity() ? first(world.grid.velocity_old[number]) : nullptr, first(world.grid.mixture)};
}

/// Adds a particle of `set` to every field of the grid that it takes part in. `N`: Node<R>, or what
/// works as one, {x, y, z, m}. `node(i, j, k)`: the index of a node of the stencil, i, j, k from 0
/// to 2.
template <class R, class N, class NodeIndex>
void add_particle(const World<R>& world, const ParticleSet<R>& set, const SetStep<R>& step, const Stencil<R>& stencil,
                  const ParticleTerms<R>& terms, const NodesToAddTo<R, N>& to, const NodeIndex& node) {
  const auto add = [&](N* field, const Vec3<R>& q, const Vec3<R>(&slopes)[3], R mass) {
    N slope[3];
    for (int a = 0; a < 3; ++a) slope[a] = N{slopes[a].x, slopes[a].y, slopes[a].z, R(0)};
    scatter(stencil, N{q.x, q.y, q.z, mass}, slope, [&](int i, int j, int k) -> N& { return field[node(i, j, k)]; });
  };
  Vec3<R> slopes[3], kept[3];
  for (int a = 0; a < 3; ++a) {
    slopes[a] = step.sub_cycled ? terms.affine[a] : terms.affine[a] + terms.stress[a];
    kept[a] = terms.affine[a] * step.keep_next;
  }
  add(to.own, terms.momentum, slopes, step.mass);
  if (to.stress) add(to.stress, {}, terms.stress, R(0));
  if (to.velocity_old) add(to.velocity_old, terms.momentum * step.keep_next, kept, step.mass * step.keep_next);
  if (!to.mixture) return;
  const MixtureShare<R> share(world, set, step, terms.viscosity, terms.volume_ratio);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) share.add_to(to.mixture[node(i, j, k)], stencil.weight(i, j, k));
}

/// Implements Backend::state_bounds.
template <class R>
PassStats state_bounds(const World<R>& world);

/// Implements Backend::scatter_particles. The particles must have been sorted, and `obstacles`
/// prepared since. The bits do not depend on the number of threads.
template <class R>
void scatter_particles(World<R>& world, const Motion<R>& motion, const Obstacles& obstacles);

}  // namespace dreampm
