#include "dreampm/backend/gpu/gpu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/grid_visit.h"
#include "dreampm/backend/gpu/memory_need.h"
#include "dreampm/backend/gpu/particle_arrays.h"
#include "dreampm/backend/gpu/particle_passes.h"
#include "dreampm/backend/gpu/particle_sort.h"
#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/backend/gpu/viscous_stages.h"
#include "dreampm/backend/scatter_particles.h"
#include "dreampm/base/error.h"
#include "dreampm/base/parallel.h"

namespace dreampm {
namespace {

using gpu::of_field;
using gpu::targets;

class Gpu final : public Backend<float> {
 public:
  Gpu(std::string_view name, std::unique_ptr<gpu::Device> device)
      : device_(std::move(device)),
        name_(name),
        isa_(device_->isa()),
        memory_(*device_),
        passes_(*device_, memory_),
        sort_(*device_),
        visit_(*device_),
        stages_(*device_),
        arrays_(device_) {}
  std::string_view name() const override { return name_; }
  std::string_view isa() const override { return isa_; }

  void attach(const World<float>& world) override {
    obstacles_.forget();
    home_ = MatterFields::all;
    motion_at_ = Place::home;
    whole_ = true;
    const Change change(*this);
    gpu::check_room(*device_, world);
    refresh(world);
    upload_particles(world);
  }

  void sort(World<float>& world) override {
    const Change change(*this);
    if (gpu::ParticleSort::takes(world)) {
      nodes_to_device(world);
      sort_(world, memory_);
      home_ = MatterFields::none;
      refresh(world);
      return;
    }
    bring_home(world, MatterFields::all);
    regroup_(world, next_);
    refresh(world);
    upload_particles(world);
  }

  void colliders_moved(const World<float>& world) override {
    obstacles_.prepare(world);
    update_.colliders_moved(world, obstacles_);
    visit_.colliders_moved(world, obstacles_);
    upload_obstacles(world);
  }

  PassStats insert_particles(World<float>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    const Change change(*this);
    bring_home(world, MatterFields::all);
    insert(world, set, seeds);
    gpu::check_room(*device_, world);
    refresh(world);
    upload_particles(world);
    forget_heaviest(world);
    return scatter_seeds(world, set, seeds, obstacles_);
  }

  GridStats grid_update(World<float>& world, double dt) override {
    check_whole();
    if (gpu::GridVisit::takes(world, obstacles_)) {
      nodes_to_device(world);
      home_ = without(home_, MatterFields::nodes);
      return visit_(world, memory_, obstacles_, update_, dt);
    }
    change_nodes_at_home(world);
    // Gaps are measured from the places of solids and grains.
    if (update_.gaps().has(world, 0) || update_.gaps().has(world, 1)) bring_home(world, MatterFields::position);
    return update_(world, obstacles_, dt);
  }

  double sub_cycle(World<float>& world, double dt, GridStats& found) override {
    fit_grid(world, next_);
    if (gpu::GridVisit::takes(world, obstacles_)) {
      nodes_to_device(world);
      home_ = without(home_, MatterFields::nodes);
      return stages_(world, memory_, visit_, passes_, obstacles_, update_, next_, dt, found);
    }
    change_nodes_at_home(world);
    const auto lend_velocities = [&] {
      for (std::size_t f = 0; f < 2; ++f) memory_.nodes[of_field(gpu::nodes, f)].upload(world.grid.field(f));
    };
    return update_.sub_cycle(
        world, obstacles_, dt, found, next_,
        [&] {
          lend_velocities();
          passes_.find_viscous_forces(world, dt, next_);
          for (std::size_t f = 0; f < 2; ++f) memory_.momenta[f].download(next_.field(f));
        },
        [&] {
          lend_velocities();
          return passes_.fastest_particle(world);
        });
  }

  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    fit_grid(world, next_);
    nodes_to_device(world);
    visit_.add_image_mass(world, memory_, dt);
    if (obstacles_.any_thin()) upload_distances(world);
    upload_base(world);
    const PassStats total = passes_.g2p2g(world, dt, dt_next, motion != nullptr, obstacles_.any_thin(), next_);
    if (!total.finite) return total;
    swap_fields(world.grid, next_);
    home_ = includes(home_, MatterFields::id) ? MatterFields::id : MatterFields::none;
    if (motion) motion_at_ = Place::device;
    return total;
  }

  PassStats state_bounds(const World<float>& world) override {
    return dreampm::state_bounds(at_home(world, MatterFields::particles));
  }

  void scatter_particles(World<float>& world, const Motion<float>& motion) override {
    bring_home(world, MatterFields::particles);
    // All nodes are written anew.
    home_ = home_ | MatterFields::nodes;
    nodes_there_ = false;
    forget_heaviest(world);
    dreampm::scatter_particles(world, motion, obstacles_);
  }

  void download(World<float>& world, Motion<float>& motion, MatterFields fields) override {
    bring_home(world, fields);
    if (!includes(fields, MatterFields::motion) || motion_at_ != Place::device) return;
    passes_.download_motion(world, motion);
    motion_at_ = Place::both;
  }
  void upload(const World<float>& world, const Motion<float>&, MatterFields fields) override {
    const Change change(*this);
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      if (includes(fields, MatterFields::position))
        memory_.sets[s].upload_position(world.sets[s], world.particle_blocks.size());
      if (includes(fields, MatterFields::state)) memory_.sets[s].upload_state(world.sets[s]);
      if (includes(fields, MatterFields::id)) memory_.sets[s].id.upload(world.sets[s].id);
    }
    if (includes(fields, MatterFields::nodes)) nodes_there_ = false;
    if (includes(fields, MatterFields::motion)) motion_at_ = Place::home;
    home_ = home_ | fields;
  }
  std::optional<DeviceParticles> device_particles(const World<float>& world, const Motion<float>& motion,
                                                  std::size_t set, const ParticleFields& fields) override {
    check_whole();
    return arrays_(world, set, memory_.sets.at(set), motion_at_ == Place::home ? &motion : nullptr, fields);
  }

  Balance balance(const World<float>& world, const Motion<float>& motion) override {
    return dreampm::balance(at_home(world, MatterFields::particles), at_home(world, motion));
  }
  double stress_power(const World<float>& world, const Motion<float>& motion) override {
    return dreampm::stress_power(at_home(world, MatterFields::particles), at_home(world, motion));
  }
  ImpulseSum grid_momentum(const World<float>& world, NodesHold hold) override {
    return dreampm::grid_momentum(at_home(world, MatterFields::nodes), hold);
  }

 private:
  // ---- where the matter is

  /// What an exception would leave half done: the lists of the World and of the device differ then,
  /// and nothing but attach() helps.
  class Change {
   public:
    explicit Change(Gpu& gpu) : gpu_(gpu), thrown_(std::uncaught_exceptions()) { gpu.check_whole(); }
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;
    ~Change() { gpu_.whole_ = std::uncaught_exceptions() == thrown_; }

   private:
    Gpu& gpu_;
    int thrown_;
  };
  void check_whole() const {
    if (!whole_) fail_run("{}: an earlier failure left the matter there half changed", device_->about());
  }

  /// Copies what `fields` name to the World, where its arrays are not current.
  void bring_home(World<float>& world, MatterFields fields) {
    const auto wants = [&](MatterFields part) { return includes(fields, part) && !includes(home_, part); };
    const bool id = wants(MatterFields::id), position = wants(MatterFields::position),
               state = wants(MatterFields::state);
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      if (id) memory_.sets[s].id.download(world.sets[s].id);
      if (position) memory_.sets[s].download_position(world.sets[s]);
      if (state) memory_.sets[s].download_state(world.sets[s]);
    }
    if (wants(MatterFields::nodes))
      for (std::size_t t = 0; t < targets; ++t) memory_.nodes[t].download(gpu::host_field(world.grid, t));
    home_ = home_ | fields;
  }
  /// The world with what `fields` name; a copy of it where that is not there.
  const World<float>& at_home(const World<float>& world, MatterFields fields) {
    const MatterFields before = home_;
    if (includes(before, without(fields, MatterFields::motion))) return world;
    copy_ = world;
    bring_home(copy_, fields);
    home_ = before;
    return copy_;
  }
  /// The motion of the last pass; a copy of it where `given` is not current.
  const Motion<float>& at_home(const World<float>& world, const Motion<float>& given) {
    if (motion_at_ != Place::device) return given;
    passes_.download_motion(world, motion_);
    return motion_;
  }
  /// The whole world, which is at home.
  void upload_particles(const World<float>& world) {
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      memory_.sets[s].upload_position(world.sets[s], world.particle_blocks.size());
      memory_.sets[s].upload_state(world.sets[s]);
      memory_.sets[s].id.upload(world.sets[s].id);
    }
    home_ = home_ | MatterFields::particles;
    nodes_there_ = false;
  }
  /// The host gave matter to the nodes: the next pass counts by what its blocks hold.
  static void forget_heaviest(World<float>& world) { world.scatter_bounds[1] = 0; }
  /// Brings the nodes home, where they will change.
  void change_nodes_at_home(World<float>& world) {
    bring_home(world, MatterFields::nodes);
    nodes_there_ = false;
  }
  void nodes_to_device(World<float>& world) {
    if (nodes_there_) return;
    for (std::size_t t = 0; t < targets; ++t) memory_.nodes[t].upload(gpu::host_field(world.grid, t));
    nodes_there_ = true;
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
    passes_.prepare(blocks);
    visit_.prepare(world, obstacles_, update_);
    upload_obstacles(world);
  }
  void upload_obstacles(const World<float>& world) {
    std::vector<BlockWalls<float>> walls(world.particle_blocks.size());
    std::vector<std::uint32_t> beside, apart;
    for (std::size_t b = 0; b < walls.size(); ++b) {
      walls[b] = block_walls(world, world.particle_blocks[b], colliders_near(obstacles_, stencil_blocks_[b]));
      (walls[b].colliders ? beside : apart).push_back(static_cast<std::uint32_t>(b));
    }
    memory_.walls.upload(walls), memory_.beside.upload(beside), memory_.apart.upload(apart);
    memory_.clearance.upload(obstacles_.clearance());
    based_ = false;
  }

  /// The colliders' share of the mixture, with which the grid of the step to come begins.
  void upload_base(const World<float>& world) {
    if (based_) return;
    Nodes<float>& base = next_.mixture;
    std::fill(base.begin(), base.end(), Node<float>{});
    if (!base.empty() && obstacles_.any())
      parallel_for(world.grid.blocks.size(), 32,
                   [&](std::size_t b) { add_colliders(world, obstacles_, b, base.data() + b * block_nodes); });
    memory_.base.upload(base);
    based_ = true;
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

  std::shared_ptr<gpu::Device> device_;  ///< arrays that left it keep it, too
  std::string name_, isa_;
  gpu::Memory memory_;
  Obstacles obstacles_;
  Regroup<float> regroup_;
  GridUpdate<float> update_;
  gpu::ParticlePasses passes_;
  gpu::ParticleSort sort_;
  gpu::GridVisit visit_;
  gpu::ViscousStages stages_;
  gpu::ParticleArrays arrays_;
  std::vector<StencilBlocks> stencil_blocks_;  ///< by block of particles
  GridFields<float> next_;                     ///< its block list stays empty
  bool based_ = false;                         ///< whether Memory::base is current
  /// The parts of the matter of which the World's arrays are current, and whether the device's
  /// nodes are. Its particles always are.
  MatterFields home_ = MatterFields::all;
  bool nodes_there_ = false;
  /// Where the motion of the last pass that was asked for one is current.
  enum class Place { home, device, both } motion_at_ = Place::home;
  bool whole_ = true;     ///< see Change
  World<float> copy_;     ///< for at_home()
  Motion<float> motion_;  ///< the same
};

}  // namespace

std::unique_ptr<Backend<float>> make_gpu_backend(std::string_view name, std::unique_ptr<gpu::Device> device) {
  return std::make_unique<Gpu>(name, std::move(device));
}

}  // namespace dreampm
