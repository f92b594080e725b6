#include "dreampm/state/world.h"

#include <algorithm>
#include <utility>

#include "dreampm/base/hash.h"
#include "dreampm/base/order.h"
#include "dreampm/physics/materials.h"

namespace dreampm {
namespace {

void add(Hash64& h, const Vec3i& v) { h.add(v.x), h.add(v.y), h.add(v.z); }

void add(Hash64& h, const Vec3d& v) { h.add(v.x), h.add(v.y), h.add(v.z); }

void add_field(Hash64& h, const ForceField& f) {
  h.add(std::string_view(f.name));
  std::visit(
      [&]<class F>(const F& one) {
        h.add(F::name);
        for (const auto& p : F::params) {
          if (p.number) h.add(one.*p.number);
          if (p.vector) add(h, one.*p.vector);
        }
      },
      f.field);
  h.add(f.box.has_value());
  if (f.box) add(h, f.box->min), add(h, f.box->max);
}

template <class R>
void add_set(Hash64& h, const World<R>& world, const ParticleSet<R>& set) {
  h.add(std::string_view(set.name));
  h.add(std::string_view(set.material));
  for (const auto& [key, value] : set.values) h.add(std::string_view(key)), h.add(value);
  h.add(set.mass), h.add(set.rest_volume);
  if (set.transfer.keeps_velocity() || set.transfer.affine != 1)
    h.add(set.transfer.affine), h.add(set.transfer.blend), h.add(set.transfer.advance);
  std::vector<std::uint32_t> block(set.size());
  for (std::size_t b = 0; b + 1 < set.block_start.size(); ++b)
    std::fill(block.begin() + set.block_start[b], block.begin() + set.block_start[b + 1],
              static_cast<std::uint32_t>(b));
  for (const std::uint32_t p : order_of<std::uint32_t>(set.id)) {
    h.add(set.id[p]);
    add(h, first_stencil(world.particle_blocks[block[p]]) - world.low);
    for (const auto& axis : set.u) h.add(axis[p]);
    for (const auto& column : set.state) h.add(column[p]);
    for (const auto& axis : set.own)
      if (!axis.empty()) h.add(axis[p]);
  }
}

}  // namespace

template <class R>
bool World<R>::measures_by_volume(std::size_t field) const {
  const auto any = [&](const auto& is) {
    return std::any_of(sets.begin(), sets.end(), [&](const auto& set) { return field_of(set) == field && is(set); });
  };
  double density = 0;
  const bool several = any([&](const ParticleSet<R>& set) {
    const double before = std::exchange(density, set.mass / set.rest_volume);
    return before > 0 && density != before;
  });
  return several && any([](const ParticleSet<R>& set) {
           bool wants = false;
           Materials::with(set.material, [&]<class M>() { wants = M::wants_density; });
           return wants;
         });
}

template <class R>
std::uint64_t state_hash(const World<R>& world) {
  Hash64 h;
  h.add(world.step), h.add(world.frame), h.add(world.time), h.add(world.dt_next), h.add(world.dt_limiter);
  if (world.viscous_stages > 0) h.add(world.viscous_stages);
  if (!world.settings.sub_cycles) h.add(world.settings.sub_cycles);
  h.add(world.dx);
  add(h, world.high - world.low);
  for (const Wall& w : world.walls) h.add(w.type), h.add(w.friction), h.add(w.skin_friction);
  for (const bool p : world.periodic) h.add(p);
  h.add(world.gravity.x), h.add(world.gravity.y), h.add(world.gravity.z);
  for (const auto& k : world.gravity_keys) h.add(k.t), h.add(k.value.x), h.add(k.value.y), h.add(k.value.z);
  for (const ForceField& f : world.fields) add_field(h, f);
  const StepSettings& s = world.settings;
  h.add(s.fps), h.add(s.cfl), h.add(s.fixed_dt), h.add(s.dt_max), h.add(s.damping), h.add(s.keep_inside);
  h.add(world.drift), h.add(world.wave_speed), h.add(world.viscosity), h.add(world.left);
  for (const Collider& c : world.colliders) {
    h.add(std::string_view(c.name)), h.add(c.type), h.add(c.friction);
    if (c.holds) h.add(c.holds);
  }
  for (const auto& set : world.sets) add_set(h, world, set);
  for (std::size_t b = 0; b < world.grid.blocks.size(); ++b) add(h, world.grid.blocks[b] * block_width - world.low);
  h.bytes(world.grid.nodes.data(), world.grid.nodes.size() * sizeof(Node<R>));
  h.bytes(world.grid.solids.data(), world.grid.solids.size() * sizeof(Node<R>));
  h.bytes(world.grid.mixture.data(), world.grid.mixture.size() * sizeof(Node<R>));
  for (const auto& before : world.grid.velocity_old)
    if (!before.empty()) h.bytes(before.data(), before.size() * sizeof(Node<R>));
  for (const auto& stress : world.grid.stress)
    if (!stress.empty()) h.bytes(stress.data(), stress.size() * sizeof(Node<R>));
  return h.value();
}

template bool World<float>::measures_by_volume(std::size_t) const;
template bool World<double>::measures_by_volume(std::size_t) const;
template std::uint64_t state_hash(const World<float>&);
template std::uint64_t state_hash(const World<double>&);

}  // namespace dreampm
