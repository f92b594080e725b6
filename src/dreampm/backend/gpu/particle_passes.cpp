#include "dreampm/backend/gpu/particle_passes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dreampm::gpu {
namespace {

/// `speed` [m/s]: of the fastest node.
ScatterBounds assumed_bounds(const World<float>& world, double speed) {
  const auto& [scattered, mass, ratio, viscosity] = world.scatter_bounds;
  double one = 0;  // no less than a particle's whole
  for (const ParticleSet<float>& set : world.sets) one = std::max(one, set.mass);
  return widened({static_cast<float>(std::max(scattered, speed)),
                  static_cast<float>(mass > 0 ? std::max(mass, one) : 1e20), static_cast<float>(std::max(ratio, 2.0)),
                  static_cast<float>(std::max(viscosity, world.viscosity))});
}

}  // namespace

void ParticlePasses::prepare(std::size_t particle_blocks) {
  blocks_ = particle_blocks;
  std::vector<Range> ranges;
  add_ranges(0, static_cast<std::uint32_t>(blocks_), ranges);
  memory_.block_ranges.upload(ranges);
}

PassStats ParticlePasses::g2p2g(World<float>& world, double dt, double dt_next, bool looks, bool thin,
                                GridFields<float>& next) {
  const PassStep step{world, next, dt, dt_next, looks, thin};
  for (SetMemory& set : memory_.sets)
    if (looks) set.fit_motion();
  ScatterBounds bounds = assumed_bounds(world, world.node_speed);
  PassStats total;
  for (;;) {
    const ScatterBounds found = pass(step, bounds, total);
    if (!total.finite) return total;
    if (within(found, bounds)) {
      world.scatter_bounds = {found.speed, found.mass, found.volume_ratio, found.viscosity};
      break;
    }
    bounds = largest(bounds, widened(found));
  }
  for (std::size_t t = 0; t < targets; ++t) sum_arenas(t, bounds, next, memory_.nodes[t]);
  // Without a block nothing was passed over, and nothing was written.
  for (std::size_t s = 0; blocks_ > 0 && s < world.sets.size(); ++s)
    memory_.sets[s].swap(world.sets[s].transfer.keeps_velocity());
  return total;
}

PassInput ParticlePasses::input_of(const World<float>& world, std::size_t s, bool thin) const {
  const ParticleSet<float>& set = world.sets[s];
  const SetMemory& memory = memory_.sets[s];
  const std::size_t field = world.field_of(set);
  PassInput in{nullptr,
               memory.now.pointers(set.transfer.keeps_velocity()),
               memory.block_start.data(),
               memory_.stencil_blocks.data(),
               memory_.walls.data(),
               memory_.loads.data(),
               memory_.nodes[of_field(nodes, field)].data(),
               set.transfer.keeps_velocity() ? memory_.nodes[of_field(old_nodes, field)].data() : nullptr,
               memory_.nodes[mixture_share].data(),
               memory_.clearance.data(),
               {}};
  if (thin)
    for (std::size_t c = 0; c < 4; ++c) in.distance[c] = memory.distance[c].data();
  return in;
}

/// Takes a set's turn to write to a target's arenas.
ArenaOutput ParticlePasses::arena(std::size_t target, GridFields<float>& next) {
  if (host_field(next, target).empty()) return {nullptr, false};
  memory_.arenas[target].resize(blocks_ * arena_nodes);
  return {memory_.arenas[target].data(), !std::exchange(written_[target], true)};
}

/// One pass over all sets. Adds up `total`, and returns the bounds of what was scattered.
ScatterBounds ParticlePasses::pass(const PassStep& step, const ScatterBounds& bounds, PassStats& total) {
  const World<float>& world = step.world;
  total = {};
  written_ = {};
  const std::size_t parts = memory_.block_ranges.size();
  memory_.totals.resize(world.sets.size() * parts);
  memory_.block_sums.resize(blocks_);
  for (std::size_t s = 0; parts > 0 && s < world.sets.size(); ++s) {
    launch_pass(step, s, bounds);
    launch(*device_,
           AddUp<BlockSums>{memory_.block_sums.data(), memory_.block_ranges.data(), memory_.totals.data() + s * parts},
           parts);
  }
  totals_.assign(world.sets.size() * parts, BlockSums::none());
  memory_.totals.download(totals_);
  ScatterBounds found{};
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    BlockSums sums = BlockSums::none();
    for (std::size_t i = 0; i < parts; ++i) sums.add(totals_[s * parts + i]);
    total.add(stats_of(world, world.sets[s], sums));
    found = largest(found, sums.scattered);
  }
  return found;
}

void ParticlePasses::launch_pass(const PassStep& pass, std::size_t s, const ScatterBounds& bounds) {
  const World<float>& world = pass.world;
  const ParticleSet<float>& set = world.sets[s];
  SetMemory& memory = memory_.sets[s];
  const std::size_t field = world.field_of(set);
  const bool keeps = set.transfer.keeps_velocity();
  const SetStep<float> step = set_step(world, set, pass.dt, pass.dt_next);
  PassOutput out{};
  memory.next.fit(memory.now);
  out.particles = memory.next.pointers(keeps);
  out.field = arena(of_field(nodes, field), pass.next);
  if (keeps) out.velocity_old = arena(of_field(old_nodes, field), pass.next);
  if (step.sub_cycled) out.stress = arena(of_field(stress_nodes, field), pass.next);
  if (world.mixes_matter()) out.mixture = arena(mixture_share, pass.next);
  out.sums = memory_.block_sums.data();
  if (pass.looks) memory.output_to(out);
  const bool plain = !keeps && !step.sub_cycled && !out.mixture.counts;
  Materials::with(set.material, [&]<class M>() {
    const auto law = M::template Law<float>::from(set.values);
    const auto visit = [&]<bool relaxes, bool is_plain>(const Buffer<std::uint32_t>* some) {
      Pass<M, relaxes, is_plain> kernel{law,
                                        step,
                                        bounds,
                                        input_of(world, s, pass.thin),
                                        out,
                                        static_cast<int>(field),
                                        world.measures_by_volume(field)};
      if (some) kernel.in.some = some->data();
      launch(*device_, kernel, some ? some->size() : blocks_);
    };
    const auto all = [&]<bool relaxes>() {
      if (!plain) return visit.template operator()<relaxes, false>(nullptr);
      visit.template operator()<relaxes, true>(&memory_.apart);
      visit.template operator()<relaxes, false>(&memory_.beside);
    };
    if constexpr (VolumeRelaxed<M>)
      if (step.volume_relaxation > 0) return all.template operator()<true>();
    all.template operator()<false>();
  });
}

/// Brings what the arenas of a target hold to the nodes.
void ParticlePasses::sum_arenas(std::size_t target, const ScatterBounds& bounds, GridFields<float>& next,
                                Buffer<Node<float>>& to) {
  const std::size_t size = host_field(next, target).size();
  to.resize(size);
  launch(*device_,
         SumArenas{written_[target] ? memory_.arenas[target].data() : nullptr, memory_.sources.first.data(),
                   memory_.sources.arena.data(), memory_.sources.corner.data(), memory_.loads.data(),
                   target == mixture_share ? memory_.base.data() : nullptr, to.data(), bounds, unit_field(target)},
         size / block_nodes);
}

void ParticlePasses::download_motion(const World<float>& world, Motion<float>& motion) const {
  motion.sets.resize(world.sets.size());
  for (std::size_t s = 0; s < world.sets.size(); ++s) memory_.sets[s].download_motion(motion.sets[s]);
}

void ParticlePasses::find_viscous_forces(World<float>& world, double dt, GridFields<float>& next) {
  // World::node_speed is that of the step before, and no state. The particles lie where they were
  // when they gave their masses to the nodes: so the heaviest of these is known.
  ScatterBounds bounds = assumed_bounds(world, 0);
  for (;;) {
    written_ = {};
    const float speed = launch_viscous(world, dt, bounds, next);
    if (!(speed > bounds.speed)) break;
    bounds = largest(bounds, widened({speed, 0, 0, 0}));
  }
  for (std::size_t f = 0; f < 2; ++f) sum_arenas(of_field(nodes, f), bounds, next, memory_.momenta[f]);
}
/// Returns the largest speed that was scattered [m/s].
float ParticlePasses::launch_viscous(World<float>& world, double dt, const ScatterBounds& bounds,
                                     GridFields<float>& next) {
  memory_.block_speeds.resize(blocks_);
  speeds_.resize(blocks_);
  float fastest = 0;
  for (std::size_t s = 0; s < world.sets.size(); ++s) {
    const ParticleSet<float>& set = world.sets[s];
    Materials::with(set.material, [&]<class M>() {
      if constexpr (Viscous<M>) {
        const std::size_t field = world.field_of(set);
        const ArenaOutput out = arena(of_field(nodes, field), next);
        launch(*device_,
               ViscousPass<M>{M::template Law<float>::from(set.values), set_step(world, set, dt, dt), bounds,
                              input_of(world, s, false), out, memory_.block_speeds.data(), static_cast<int>(field)},
               blocks_);
        memory_.block_speeds.download(speeds_);
        for (const float speed : speeds_) fastest = std::max(fastest, speed);
      }
    });
  }
  return fastest;
}
double ParticlePasses::fastest_particle(World<float>& world) {
  memory_.block_speeds.resize(blocks_);
  for (std::size_t s = 0; s < world.sets.size(); ++s)
    launch(*device_, SpeedPass{input_of(world, s, false), memory_.block_speeds.data(), s == 0}, blocks_);
  speeds_.resize(blocks_);
  memory_.block_speeds.download(speeds_);
  float fastest2 = 0;
  for (const float speed2 : speeds_) fastest2 = std::max(fastest2, speed2);
  return std::sqrt(static_cast<double>(fastest2));
}

}  // namespace dreampm::gpu
