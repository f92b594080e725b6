#include "dreampm/backend/gpu/gpu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/kernels.h"
#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/backend/scatter_particles.h"
#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

using gpu::Buffer;
using gpu::ScatterBounds;

/// The fields of the grid that particles give to, in the order of the arenas.
enum Target : std::size_t { nodes, solids, old_nodes, old_solids, stress_nodes, stress_solids, mixture_share, targets };
constexpr std::size_t of_field(Target first, std::size_t field) { return first + field; }
/// The field that decides the units of a target, as SumArenas takes it.
constexpr int unit_field(std::size_t target) { return target == mixture_share ? 2 : static_cast<int>(target % 2); }

Nodes<float>& host_field(GridFields<float>& grid, std::size_t target) {
  const std::size_t f = target % 2;
  if (target == mixture_share) return grid.mixture;
  return target < old_nodes ? grid.field(f) : target < stress_nodes ? grid.velocity_old[f] : grid.stress[f];
}

class Gpu final : public Backend<float> {
 public:
  Gpu(std::string_view name, std::unique_ptr<gpu::Device> device)
      : device_(std::move(device)), name_(name), isa_(device_->isa()), memory_(*device_) {}
  std::string_view name() const override { return name_; }
  std::string_view isa() const override { return isa_; }

  void attach(const World<float>& world) override {
    obstacles_.forget();
    refresh(world);
    upload_particles(world);
  }

  void sort(World<float>& world) override {
    bring_home(world, MatterFields::particles);
    regroup_(world, next_);
    refresh(world);
    upload_particles(world);
  }

  void colliders_moved(const World<float>& world) override {
    obstacles_.prepare(world);
    update_.colliders_moved(world, obstacles_);
    upload_obstacles(world);
  }

  PassStats insert_particles(World<float>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    bring_home(world, MatterFields::particles);
    insert(world, set, seeds);
    refresh(world);
    upload_particles(world);
    return scatter_seeds(world, set, seeds, obstacles_);
  }

  GridStats grid_update(World<float>& world, double dt) override {
    // Gaps are measured from the places of solids and grains.
    if (update_.gaps().has(world, 0) || update_.gaps().has(world, 1)) bring_home(world, MatterFields::position);
    return update_(world, obstacles_, dt);
  }

  double sub_cycle(World<float>& world, double dt, GridStats& found) override {
    fit_grid(world, next_);
    return update_.sub_cycle(
        world, obstacles_, dt, found, next_, [&] { find_viscous_forces(world, dt); },
        [&] { return fastest_particle(world); });
  }

  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    begin_pass(world, obstacles_, update_.images(), next_, dt);
    upload_nodes(world);
    if (obstacles_.any_thin()) upload_distances(world);
    ScatterBounds bounds = assumed_bounds(world, world.node_speed);
    PassStats total;
    for (;;) {
      const ScatterBounds found = pass(world, dt, dt_next, motion != nullptr, bounds, total);
      if (!total.finite) return total;
      if (gpu::within(found, bounds)) {
        world.scatter_bounds = {found.speed, found.mass, found.volume_ratio, found.viscosity};
        break;
      }
      bounds = gpu::largest(bounds, gpu::widened(found));
    }
    for (std::size_t t = 0; t < targets; ++t) sum_arenas(t, bounds);
    for (std::size_t s = 0; s < world.sets.size(); ++s) memory_.sets[s].swap(world.sets[s].transfer.keeps_velocity());
    swap_fields(world.grid, next_);
    home_ = MatterFields::id | MatterFields::nodes;
    if (motion) download_motion(world, *motion);
    return total;
  }

  PassStats state_bounds(const World<float>& world) override { return dreampm::state_bounds(at_home(world)); }

  void scatter_particles(World<float>& world, const Motion<float>& motion) override {
    bring_home(world, MatterFields::particles);
    dreampm::scatter_particles(world, motion, obstacles_);
  }

  void download(World<float>& world, Motion<float>&, MatterFields fields) override { bring_home(world, fields); }
  void upload(const World<float>& world, const Motion<float>&, MatterFields fields) override {
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      if (includes(fields, MatterFields::position))
        memory_.sets[s].upload_position(world.sets[s], world.particle_blocks.size());
      if (includes(fields, MatterFields::state)) memory_.sets[s].upload_state(world.sets[s]);
    }
    home_ = home_ | fields;
  }

  Balance balance(const World<float>& world, const Motion<float>& motion) override {
    return dreampm::balance(at_home(world), motion);
  }
  double stress_power(const World<float>& world, const Motion<float>& motion) override {
    return dreampm::stress_power(at_home(world), motion);
  }

 private:
  // ---- where the matter is

  /// Copies what `fields` name of the particles to the World, where its arrays are not current.
  void bring_home(World<float>& world, MatterFields fields) {
    const auto wants = [&](MatterFields part) { return includes(fields, part) && !includes(home_, part); };
    const bool position = wants(MatterFields::position), state = wants(MatterFields::state);
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      if (position) memory_.sets[s].download_position(world.sets[s]);
      if (state) memory_.sets[s].download_state(world.sets[s]);
    }
    if (position) home_ = home_ | MatterFields::position;
    if (state) home_ = home_ | MatterFields::state;
  }
  /// The world with all of its particles; a copy of it where they are not there.
  const World<float>& at_home(const World<float>& world) {
    if (includes(home_, MatterFields::position | MatterFields::state)) return world;
    const MatterFields before = home_;
    copy_ = world;
    bring_home(copy_, MatterFields::particles);
    home_ = before;
    return copy_;
  }
  void upload_particles(const World<float>& world) {
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      memory_.sets[s].upload_position(world.sets[s], world.particle_blocks.size());
      memory_.sets[s].upload_state(world.sets[s]);
    }
    home_ = MatterFields::all;
  }

  // ---- what follows from the lists of blocks

  void refresh(const World<float>& world) {
    obstacles_.prepare(world);
    find_stencil_blocks(world, stencil_blocks_);
    update_.prepare(world, obstacles_);
    const std::size_t blocks = world.particle_blocks.size();
    std::vector<gpu::BlockLoad> loads(blocks);
    for (std::size_t b = 0; b < blocks; ++b) loads[b] = gpu::load_of(world, b);
    memory_.loads.upload(loads);
    memory_.stencil_blocks.upload(gpu::flat(stencil_blocks_));
    memory_.sources.upload(stencil_blocks_, world.grid.blocks.size());
    upload_obstacles(world);
  }
  void upload_obstacles(const World<float>& world) {
    std::vector<BlockWalls<float>> walls(world.particle_blocks.size());
    for (std::size_t b = 0; b < walls.size(); ++b)
      walls[b] = block_walls(world, world.particle_blocks[b], colliders_near(obstacles_, stencil_blocks_[b]));
    memory_.walls.upload(walls);
    memory_.clearance.upload(obstacles_.clearance());
  }

  // ---- what a pass reads

  void upload_nodes(World<float>& world) {
    for (std::size_t t = 0; t < targets; ++t)
      if (t != stress_nodes && t != stress_solids) memory_.nodes[t].upload(host_field(world.grid, t));
  }
  /// Distances from colliders that are too thin for the splines between the nodes.
  void upload_distances(World<float>& world) {
    bring_home(world, MatterFields::position);
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const ParticleSet<float>& set = world.sets[s];
      std::array<std::vector<float>, 4> distance;
      for (auto& column : distance) column.assign(set.size(), no_distance);
      if (set.size() > 0)
        parallel_for(world.particle_blocks.size(), 8, [&](std::size_t b) {
          const ThinWalls thin(obstacles_, stencil_blocks_[b]);
          if (thin.any())
            thin.fill({set.u[0].data(), set.u[1].data(), set.u[2].data()}, set.block_start[b], set.block_start[b + 1],
                      distance);
        });
      for (std::size_t c = 0; c < 4; ++c) memory_.sets[s].distance[c].upload(distance[c]);
    }
  }

  gpu::PassInput input_of(const World<float>& world, std::size_t s) const {
    const ParticleSet<float>& set = world.sets[s];
    const gpu::SetMemory& memory = memory_.sets[s];
    const std::size_t field = world.field_of(set);
    gpu::PassInput in{memory.now.pointers(set.transfer.keeps_velocity()),
                      memory.block_start.data(),
                      memory_.stencil_blocks.data(),
                      memory_.walls.data(),
                      memory_.loads.data(),
                      memory_.nodes[of_field(nodes, field)].data(),
                      set.transfer.keeps_velocity() ? memory_.nodes[of_field(old_nodes, field)].data() : nullptr,
                      memory_.nodes[mixture_share].data(),
                      memory_.clearance.data(),
                      {}};
    if (obstacles_.any_thin())
      for (std::size_t c = 0; c < 4; ++c) in.distance[c] = memory.distance[c].data();
    return in;
  }

  // ---- passes

  /// `speed` [m/s]: of the fastest node.
  static ScatterBounds assumed_bounds(const World<float>& world, double speed) {
    const auto& [scattered, mass, ratio, viscosity] = world.scatter_bounds;
    double one = 0;  // no less than a particle's whole
    for (const ParticleSet<float>& set : world.sets) one = std::max(one, set.mass);
    return gpu::widened(
        {static_cast<float>(std::max(scattered, speed)), static_cast<float>(mass > 0 ? std::max(mass, one) : 1e20),
         static_cast<float>(std::max(ratio, 2.0)), static_cast<float>(std::max(viscosity, world.viscosity))});
  }

  /// Takes a set's turn to write to a target's arenas.
  gpu::PassOutput::Arena arena(std::size_t target) {
    if (host_field(next_, target).empty()) return {nullptr, false};
    memory_.arenas[target].resize(stencil_blocks_.size() * gpu::arena_nodes);
    return {memory_.arenas[target].data(), !std::exchange(written_[target], true)};
  }

  /// One pass over all sets. Adds up `total`, and returns the bounds of what was scattered.
  ScatterBounds pass(World<float>& world, double dt, double dt_next, bool looks, const ScatterBounds& bounds,
                     PassStats& total) {
    const int blocks = static_cast<int>(stencil_blocks_.size());
    total = {};
    written_ = {};
    memory_.totals.resize(world.sets.size());
    memory_.block_sums.resize(stencil_blocks_.size());
    for (std::size_t s = 0; blocks > 0 && s < world.sets.size(); ++s) {
      launch_pass(world, s, dt, dt_next, looks, bounds);
      launch(gpu::AddUp{memory_.block_sums.data(), memory_.totals.data() + s, blocks}, 1);
    }
    std::vector<gpu::BlockSums> sums(world.sets.size(), gpu::BlockSums::none());
    if (blocks > 0) memory_.totals.download(sums);
    ScatterBounds found{};
    for (std::size_t s = 0; s < sums.size(); ++s) {
      total.add(gpu::stats_of(world, world.sets[s], sums[s]));
      found = gpu::largest(found, sums[s].scattered);
    }
    return found;
  }

  void launch_pass(World<float>& world, std::size_t s, double dt, double dt_next, bool looks,
                   const ScatterBounds& bounds) {
    const ParticleSet<float>& set = world.sets[s];
    gpu::SetMemory& memory = memory_.sets[s];
    const std::size_t field = world.field_of(set);
    const bool keeps = set.transfer.keeps_velocity();
    const SetStep<float> step = set_step(world, set, dt, dt_next);
    gpu::PassOutput out{};
    memory.next.fit(memory.now);
    out.particles = memory.next.pointers(keeps);
    out.field = arena(of_field(nodes, field));
    if (keeps) out.velocity_old = arena(of_field(old_nodes, field));
    if (step.sub_cycled) out.stress = arena(of_field(stress_nodes, field));
    out.mixture = arena(mixture_share);
    out.sums = memory_.block_sums.data();
    if (looks) memory.output_to(out);
    const bool plain = !keeps && !step.sub_cycled && !out.mixture.counts && !obstacles_.any();
    Materials::with(set.material, [&]<class M>() {
      const auto with = [&]<bool relaxes, bool is_plain>() {
        launch(
            gpu::Pass<M, relaxes, is_plain>{M::template Law<float>::from(set.values), step, bounds, input_of(world, s),
                                            out, static_cast<int>(field), world.measures_by_volume(field)},
            static_cast<int>(stencil_blocks_.size()));
      };
      if constexpr (VolumeRelaxed<M>)
        if (step.volume_relaxation > 0)
          return plain ? with.template operator()<true, true>() : with.template operator()<true, false>();
      plain ? with.template operator()<false, true>() : with.template operator()<false, false>();
    });
  }

  /// Brings what the arenas of a target hold to the grid of the step to come.
  void sum_arenas(std::size_t target, const ScatterBounds& bounds) {
    Nodes<float>& to = host_field(next_, target);
    if (to.empty()) return;
    Buffer<Node<float>>& nodes = memory_.nodes[target];
    const bool based = target == mixture_share;
    if (based) memory_.base.upload(to);
    nodes.resize(to.size());
    if (!written_[target]) {
      if (!based) std::fill(to.begin(), to.end(), Node<float>{});
      return;
    }
    launch(gpu::SumArenas{memory_.arenas[target].data(), memory_.sources.first.data(), memory_.sources.arena.data(),
                          memory_.sources.corner.data(), memory_.loads.data(), based ? memory_.base.data() : nullptr,
                          nodes.data(), bounds, unit_field(target)},
           static_cast<int>(to.size() / block_nodes));
    nodes.download(to);
  }

  void download_motion(const World<float>& world, Motion<float>& motion) {
    motion.sets.resize(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) memory_.sets[s].download_motion(motion.sets[s]);
  }

  // ---- stages of viscosity

  void find_viscous_forces(World<float>& world, double dt) {
    for (std::size_t f = 0; f < 2; ++f) memory_.nodes[of_field(nodes, f)].upload(world.grid.field(f));
    // World::node_speed is that of the step before, and no state. The mass of nodes is not known
    // where matter came in since the last pass: what the blocks hold bounds it.
    ScatterBounds bounds = assumed_bounds(world, 0);
    bounds.mass = 1e20f;
    for (;;) {
      written_ = {};
      const float speed = launch_viscous(world, dt, bounds);
      if (!(speed > bounds.speed)) break;
      bounds = gpu::largest(bounds, gpu::widened({speed, 0, 0, 0}));
    }
    for (std::size_t f = 0; f < 2; ++f) sum_arenas(of_field(nodes, f), bounds);
  }
  /// Returns the largest speed that was scattered [m/s].
  float launch_viscous(World<float>& world, double dt, const ScatterBounds& bounds) {
    memory_.block_speeds.resize(stencil_blocks_.size());
    std::vector<float> speeds(stencil_blocks_.size());
    float fastest = 0;
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      const ParticleSet<float>& set = world.sets[s];
      Materials::with(set.material, [&]<class M>() {
        if constexpr (Viscous<M>) {
          const std::size_t field = world.field_of(set);
          const gpu::PassOutput::Arena out = arena(of_field(nodes, field));
          launch(gpu::ViscousPass<M>{M::template Law<float>::from(set.values), set_step(world, set, dt, dt), bounds,
                                     input_of(world, s), out, memory_.block_speeds.data(), static_cast<int>(field)},
                 static_cast<int>(stencil_blocks_.size()));
          memory_.block_speeds.download(speeds);
          for (const float speed : speeds) fastest = std::max(fastest, speed);
        }
      });
    }
    return fastest;
  }
  /// m/s: the largest speed that a particle gathers.
  double fastest_particle(World<float>& world) {
    for (std::size_t f = 0; f < 2; ++f) memory_.nodes[of_field(nodes, f)].upload(world.grid.field(f));
    memory_.block_speeds.resize(stencil_blocks_.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s)
      launch(gpu::SpeedPass{input_of(world, s), memory_.block_speeds.data(), s == 0},
             static_cast<int>(stencil_blocks_.size()));
    std::vector<float> speeds(stencil_blocks_.size());
    memory_.block_speeds.download(speeds);
    float fastest2 = 0;
    for (const float speed2 : speeds) fastest2 = std::max(fastest2, speed2);
    return std::sqrt(static_cast<double>(fastest2));
  }

  template <class K>
  void launch(const K& kernel, int blocks) {
    if (blocks == 0) return;
    device_->launch(gpu::Kernels::number_of<K>(), &kernel, blocks);
  }

  std::unique_ptr<gpu::Device> device_;
  std::string name_, isa_;
  gpu::Memory memory_;
  Obstacles obstacles_;
  Regroup<float> regroup_;
  GridUpdate<float> update_;
  std::vector<StencilBlocks> stencil_blocks_;  ///< by block of particles
  GridFields<float> next_;                     ///< its block list stays empty
  std::array<bool, targets> written_{};        ///< whether a set of this pass has written to a target's arenas
  /// The parts of the matter of which the World's arrays are current. Nodes always are.
  MatterFields home_ = MatterFields::all;
  World<float> copy_;  ///< for at_home()
};

}  // namespace

std::unique_ptr<Backend<float>> make_gpu_backend(std::string_view name, std::unique_ptr<gpu::Device> device) {
  return std::make_unique<Gpu>(name, std::move(device));
}

}  // namespace dreampm
