// A backend that keeps its matter away from the World, as one on a device does: whoever reads the
// World's arrays without a download reads nonsense.
#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "dreampm/backend/backend.h"
#include "dreampm/state/block_bounds.h"

namespace dreampm::test {

/// Overwrites what `fields` name; no array changes its length.
template <class R>
void spoil(World<R>& world, Motion<R>& motion, MatterFields fields) {
  constexpr R nonsense = std::numeric_limits<R>::quiet_NaN();
  const auto fill = [](auto& numbers, const auto& value) { std::fill(numbers.begin(), numbers.end(), value); };
  for (ParticleSet<R>& set : world.sets) {
    if (includes(fields, MatterFields::id)) fill(set.id, 0u);
    if (includes(fields, MatterFields::position)) {
      for (auto& axis : set.u) fill(axis, nonsense);
      fill(set.block_start, 0u);
    }
    if (includes(fields, MatterFields::state)) {
      for (auto& column : set.state) fill(column, nonsense);
      for (auto& axis : set.own_velocity) fill(axis, nonsense);
    }
  }
  if (includes(fields, MatterFields::position)) fill(world.particle_blocks, Vec3i{});
  if (includes(fields, MatterFields::motion))
    for (auto& m : motion.sets) {
      fill(m.velocity, Vec3<R>{nonsense, nonsense, nonsense});
      fill(m.gradient, Mat3<R>::diagonal(nonsense, nonsense, nonsense));
      fill(m.energy, nonsense), fill(m.volume_ratio, nonsense);
    }
  if (includes(fields, MatterFields::nodes)) world.grid = {};
}

/// Every part that `fields` do not name.
inline MatterFields others(MatterFields fields) {
  return static_cast<MatterFields>(static_cast<unsigned>(MatterFields::all) & ~static_cast<unsigned>(fields));
}

template <class R>
class Away final : public Backend<R> {
 public:
  explicit Away(std::unique_ptr<Backend<R>> inner) : inner_(std::move(inner)) {}

  std::string_view name() const override { return inner_->name(); }
  std::string_view isa() const override { return inner_->isa(); }
  void attach(const World<R>& world) override {
    kept_ = world;
    inner_->attach(world);
  }
  void sort(World<R>& world) override {
    at_home(world, [&] { inner_->sort(world); });
  }
  void colliders_moved(const World<R>& world) override { inner_->colliders_moved(whole(world)); }
  PassStats insert_particles(World<R>& world, std::size_t set, std::span<const ParticleSeed> seeds) override {
    return at_home(world, [&] { return inner_->insert_particles(world, set, seeds); });
  }
  GridStats grid_update(World<R>& world, double dt) override {
    return at_home(world, [&] { return inner_->grid_update(world, dt); });
  }
  double sub_cycle(World<R>& world, double dt, GridStats& found) override {
    return at_home(world, [&] { return inner_->sub_cycle(world, dt, found); });
  }
  PassStats g2p2g(World<R>& world, double dt, double dt_next, Motion<R>* motion) override {
    const PassStats found =
        at_home(world, [&] { return inner_->g2p2g(world, dt, dt_next, motion ? &motion_ : nullptr); });
    if (motion) {
      *motion = motion_;
      spoil(world, *motion, MatterFields::motion);
    }
    return found;
  }
  PassStats state_bounds(const World<R>& world) override { return inner_->state_bounds(whole(world)); }
  void scatter_particles(World<R>& world, const Motion<R>& motion) override {
    at_home(world, [&] { inner_->scatter_particles(world, motion); });
  }
  void download(World<R>& world, Motion<R>& motion, MatterFields fields) override {
    copy(kept_, world, fields);
    if (includes(fields, MatterFields::motion)) motion = motion_;
  }
  void download_near(World<R>& world, std::span<const Box3d> boxes) override {
    copy(kept_, world, MatterFields::position);
    for (ParticleSet<R>& set : world.sets)
      for (auto& axis : set.u) std::fill(axis.begin(), axis.end(), std::numeric_limits<R>::quiet_NaN());
    for (const std::uint32_t b : blocks_near(world, boxes))
      for (std::size_t s = 0; s < world.sets.size(); ++s) {
        const ParticleSet<R>& set = kept_.sets[s];
        for (std::size_t a = 0; set.size() > 0 && a < 3; ++a)
          std::copy(set.u[a].begin() + set.block_start[b], set.u[a].begin() + set.block_start[b + 1],
                    world.sets[s].u[a].begin() + set.block_start[b]);
      }
  }
  void upload(const World<R>& world, const Motion<R>& motion, MatterFields fields) override {
    copy(world, kept_, fields);
    if (includes(fields, MatterFields::motion)) motion_ = motion;
  }
  Balance balance(const World<R>& world, const Motion<R>&) override { return inner_->balance(whole(world), motion_); }
  double stress_power(const World<R>& world, const Motion<R>&) override {
    return inner_->stress_power(whole(world), motion_);
  }
  ImpulseSum grid_momentum(const World<R>& world, NodesHold hold) override {
    return inner_->grid_momentum(whole(world), hold);
  }

 private:
  static void copy(const World<R>& from, World<R>& to, MatterFields fields) {
    for (std::size_t s = 0; s < to.sets.size(); ++s) {
      const ParticleSet<R>& a = from.sets[s];
      ParticleSet<R>& b = to.sets[s];
      if (includes(fields, MatterFields::id)) b.id = a.id;
      if (includes(fields, MatterFields::position)) b.u = a.u, b.block_start = a.block_start;
      if (includes(fields, MatterFields::state)) b.state = a.state, b.own_velocity = a.own_velocity;
    }
    if (includes(fields, MatterFields::position)) to.particle_blocks = from.particle_blocks;
    if (includes(fields, MatterFields::nodes)) to.grid = from.grid;
  }
  World<R> whole(World<R> world) const {
    copy(kept_, world, MatterFields::all);
    return world;
  }
  /// Calls the verb of the backend inside with the arrays as that knows them, and takes them away
  /// again.
  template <class Verb>
  auto at_home(World<R>& world, const Verb& verb) {
    struct Leave {
      ~Leave() {
        Motion<R> none;
        away.kept_ = world;
        spoil(world, none, MatterFields::all);
      }
      Away& away;
      World<R>& world;
    };
    copy(kept_, world, MatterFields::all);
    const Leave leave{*this, world};
    return verb();
  }

  std::unique_ptr<Backend<R>> inner_;
  World<R> kept_;
  Motion<R> motion_;
};

}  // namespace dreampm::test
