#include "dreampm/backend/reference/reference.h"

#include <algorithm>
#include <cmath>

#include "dreampm/backend/reference/particle_pass.h"
#include "dreampm/backend/scatter_particles.h"

namespace dreampm {
namespace {

template <class R>
class Reference final : public Backend<R> {
 public:
  std::string_view name() const override { return "reference"; }
  std::string_view isa() const override { return sizeof(R) == 4 ? "scalar" : "scalar-double"; }

  void attach(const World<R>& world) override {
    around_.obstacles.forget();
    refresh(world);
  }

  void sort(World<R>& world) override {
    regroup_(world, next_);
    refresh(world);
  }

  void colliders_moved(const World<R>& world) override { refresh(world); }

  PassStats insert_particles(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    insert(world, set, seeds);
    refresh(world);
    return scatter_seeds(world, set, seeds, around_.obstacles);
  }

  PassStats state_bounds(const World<R>& world) override { return dreampm::state_bounds(world); }

  void scatter_particles(World<R>& world, const Motion<R>& motion) override {
    dreampm::scatter_particles(world, motion, around_.obstacles);
  }

  GridStats grid_update(World<R>& world, double dt) override { return update_(world, around_.obstacles, dt); }

  PassStats g2p2g(World<R>& world, double dt, double dt_next, Motion<R>* motion) override {
    begin_pass(world, around_.obstacles, update_.images(), next_, dt);
    if (motion) motion->sets.assign(world.sets.size(), {});
    PassStats sums;
    for (std::size_t s = 0; s < world.sets.size(); ++s)
      Materials::with(world.sets[s].material, [&]<class M>() {
        reference::ParticlePass<M, R> pass({world, world.sets[s], around_, next_, dt, dt_next});
        pass.grid_to_particles();
        const PassStats found = pass.update_particles(motion ? &motion->sets[s] : nullptr);
        if (found.finite) pass.particles_to_grid();
        sums.add(found);
      });
    swap_fields(world.grid, next_);
    return sums;
  }

  double sub_cycle(World<R>& world, double dt, GridStats& found) override {
    fit_grid(world, next_);
    return update_.sub_cycle(
        world, around_.obstacles, dt, found, next_, [&] { find_viscous_forces(world, dt); },
        [&] { return fastest_particle(world); });
  }

 private:
  /// Must be called after every change of the block lists.
  void refresh(const World<R>& world) {
    around_.prepare(world);
    update_.prepare(world, around_.obstacles);
  }

  void find_viscous_forces(World<R>& world, double dt) {
    std::fill(next_.nodes.begin(), next_.nodes.end(), Node<R>{});
    std::fill(next_.solids.begin(), next_.solids.end(), Node<R>{});
    for (ParticleSet<R>& set : world.sets)
      Materials::with(set.material, [&]<class M>() {
        if constexpr (Viscous<M>)
          reference::scatter_viscous_forces<M>(reference::SetContext<R>(world, set, around_, next_, dt, dt));
      });
  }

  /// m/s: the largest speed that a particle gathers.
  double fastest_particle(World<R>& world) {
    R fastest2(0);
    for (ParticleSet<R>& set : world.sets) {
      const reference::SetContext<R> context(world, set, around_, next_, 0, 0);
      context.for_each_particle([&](std::size_t block, std::size_t p) {
        const Vec3<R> v = context.nodes_of(block, p).sum(
            [&](std::size_t i) { return reference::vector_of(context.velocities()[i]); });
        fastest2 = std::max(fastest2, dot(v, v));
      });
    }
    return std::sqrt(static_cast<double>(fastest2));
  }

  reference::Surroundings around_;
  Regroup<R> regroup_;
  GridUpdate<R> update_;
  GridFields<R> next_;  ///< its block list stays empty
};

}  // namespace

template <class R>
std::unique_ptr<Backend<R>> make_reference_backend() {
  return std::make_unique<Reference<R>>();
}
template std::unique_ptr<Backend<float>> make_reference_backend();
template std::unique_ptr<Backend<double>> make_reference_backend();

}  // namespace dreampm
