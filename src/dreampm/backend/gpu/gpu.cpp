#include "dreampm/backend/gpu/gpu.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dreampm/backend/common.h"
#include "dreampm/backend/gpu/collider_nodes.h"
#include "dreampm/backend/gpu/grid_visit.h"
#include "dreampm/backend/gpu/memory_need.h"
#include "dreampm/backend/gpu/particle_arrays.h"
#include "dreampm/backend/gpu/particle_inserts.h"
#include "dreampm/backend/gpu/particle_passes.h"
#include "dreampm/backend/gpu/particle_sort.h"
#include "dreampm/backend/gpu/set_memory.h"
#include "dreampm/backend/gpu/thin_distances.h"
#include "dreampm/backend/gpu/viscous_stages.h"
#include "dreampm/backend/scatter_particles.h"
#include "dreampm/base/error.h"
#include "dreampm/state/block_bounds.h"

namespace dreampm {
namespace {

using gpu::targets;

class Gpu final : public Backend<float> {
 public:
  Gpu(std::string_view name, std::unique_ptr<gpu::Device> device)
      : device_(std::move(device)),
        name_(name),
        isa_(device_->isa()),
        memory_(*device_),
        passes_(*device_, memory_),
        some_places_(*device_),
        some_nodes_(*device_),
        layout_(*device_, some_nodes_),
        sort_(*device_, layout_, some_places_, some_nodes_),
        inserts_(*device_, layout_, some_nodes_),
        visit_(*device_),
        stages_(*device_),
        thin_(*device_),
        collider_nodes_(*device_),
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
    if (orders_there(world)) {
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
    visit_.colliders_moved(world, obstacles_, update_);
    if (!obstacles_.changed()) return;
    collider_nodes_.colliders_moved(world, memory_, obstacles_);
    find_beside(world);
    thin_.prepare(world, memory_, obstacles_, stencil_blocks_);
  }

  PassStats insert_particles(World<float>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    check_whole();
    if (orders_there(world)) {
      nodes_to_device(world);
      inserts_.begin(world, memory_, set, seeds);  // where it throws nothing has changed
      const Change change(*this);
      inserts_.place(world, memory_);
      home_ = MatterFields::none;
      refresh(world);
      forget_heaviest(world);
      return inserts_.scatter(world, memory_, obstacles_, stencil_blocks_);
    }
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
    visit_nodes_there(world);
    if (visit_.gapped()) thin_.measure(world, memory_, obstacles_, stencil_blocks_);
    return visit_(world, memory_, dt, thin_.any());
  }

  double sub_cycle(World<float>& world, double dt, GridStats& found) override {
    fit_grid(world, next_);
    visit_nodes_there(world);
    return stages_(world, memory_, visit_, passes_, next_, dt, found);
  }

  PassStats g2p2g(World<float>& world, double dt, double dt_next, Motion<float>* motion) override {
    fit_grid(world, next_);
    nodes_to_device(world);
    visit_.add_image_mass(world, memory_, dt);
    thin_.measure(world, memory_, obstacles_, stencil_blocks_);
    const PassStats total = passes_.g2p2g(world, dt, dt_next, motion != nullptr, thin_.any(), next_);
    if (!total.finite) return total;
    thin_.outdate();
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
  void download_near(World<float>& world, std::span<const Box3d> boxes) override {
    if (!includes(home_, MatterFields::position)) some_places_.download(world, memory_, blocks_near(world, boxes));
  }
  void upload(const World<float>& world, const Motion<float>&, MatterFields fields) override {
    const Change change(*this);
    memory_.resize_sets(world.sets.size());
    for (std::size_t s = 0; s < world.sets.size(); ++s) {
      if (includes(fields, MatterFields::position)) thin_.outdate();
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

  /// True if the device sorts and inserts: the host does where particles carry their motion.
  static bool orders_there(const World<float>& world) {
    return std::none_of(world.sets.begin(), world.sets.end(), [](const auto& set) { return set.carries_motion; });
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
  void nodes_to_device(World<float>& world) {
    if (nodes_there_) return;
    for (std::size_t t = 0; t < targets; ++t) memory_.nodes[t].upload(gpu::host_field(world.grid, t));
    nodes_there_ = true;
  }
  void visit_nodes_there(World<float>& world) {
    nodes_to_device(world);
    home_ = without(home_, MatterFields::nodes);
  }

  // ---- what follows from the lists of blocks

  void refresh(const World<float>& world) {
    memory_.resize_sets(world.sets.size());
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
    visit_.prepare(world, obstacles_, update_, stencil_blocks_);
    collider_nodes_.prepare(world, memory_, obstacles_);
    beside_.reset();
    find_beside(world);
    thin_.prepare(world, memory_, obstacles_, stencil_blocks_);
  }
  /// Parts the blocks of particles by whether colliders are near.
  void find_beside(const World<float>& world) {
    const std::size_t blocks = world.particle_blocks.size();
    std::vector<std::uint32_t> beside, apart;
    for (std::uint32_t b = 0; b < blocks; ++b)
      (colliders_near(obstacles_, stencil_blocks_[b]) ? beside : apart).push_back(b);
    if (beside_ == beside) return;
    std::vector<BlockWalls<float>> walls(blocks);
    for (const bool near : {false, true})
      for (const std::uint32_t b : near ? beside : apart) walls[b] = block_walls(world, world.particle_blocks[b], near);
    memory_.walls.upload(walls), memory_.beside.upload(beside), memory_.apart.upload(apart);
    beside_ = std::move(beside);
  }

  std::shared_ptr<gpu::Device> device_;  ///< arrays that left it keep it, too
  std::string name_, isa_;
  gpu::Memory memory_;
  Obstacles obstacles_;
  Regroup<float> regroup_;
  GridUpdate<float> update_;
  gpu::ParticlePasses passes_;
  gpu::SomePlaces some_places_;
  gpu::SomeNodes some_nodes_;
  gpu::GridLayout layout_;
  gpu::ParticleSort sort_;
  gpu::ParticleInserts inserts_;
  gpu::GridVisit visit_;
  gpu::ViscousStages stages_;
  gpu::ThinDistances thin_;
  gpu::ColliderNodes collider_nodes_;
  gpu::ParticleArrays arrays_;
  std::vector<StencilBlocks> stencil_blocks_;         ///< by block of particles
  GridFields<float> next_;                            ///< its block list stays empty
  std::optional<std::vector<std::uint32_t>> beside_;  ///< blocks of particles with colliders near, as Memory::beside
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
