#include "dreampm/state/world.h"

#include <algorithm>
#include <utility>

#include "dreampm/base/hash.h"
#include "dreampm/base/order.h"
#include "dreampm/physics/materials.h"
#include "dreampm/state/world_fields.h"

namespace dreampm {
namespace {

void add(Hash64& h, const Vec3i& v) { h.add(v.x), h.add(v.y), h.add(v.z); }

void add(Hash64& h, const Vec3d& v) { h.add(v.x), h.add(v.y), h.add(v.z); }

void add(Hash64& h, const Quaternion& q) { h.add(q.w), h.add(q.x), h.add(q.y), h.add(q.z); }

// A member that is added to one of these does not compile until somebody says whether it is hashed.

void add(Hash64& h, const Wall& wall) {
  const auto& [type, friction, skin_friction] = wall;
  h.add(type), h.add(friction), h.add(skin_friction);
}

void add(Hash64& h, const Key<Vec3d>& key) {
  const auto& [t, value] = key;
  h.add(t), add(h, value);
}

void add(Hash64& h, const ForceField& force) {
  const auto& [name, field, box] = force;
  h.add(std::string_view(name));
  std::visit(
      [&]<class F>(const F& one) {
        h.add(F::name);
        for (const auto& p : F::params) {
          if (p.number) h.add(one.*p.number);
          if (p.vector) add(h, one.*p.vector);
        }
      },
      field);
  h.add(box.has_value());
  if (box) add(h, box->min), add(h, box->max);
}

void add(Hash64& h, const Collider& collider) {
  const auto& [name, shape, type, friction, sticky, holds, pose, twist, surface_pose, path, rigid, changing, time,
               surface_time, slack] = collider;
  static_cast<void>(shape), static_cast<void>(path), static_cast<void>(time);  // the scene's own hash has them
  h.add(std::string_view(name)), h.add(type), h.add(friction);
  if (holds) h.add(holds);
  if (sticky > 0) h.add(sticky);
  if (rigid) h.add(rigid);
  if (slack != Collider::settle_distance) h.add(slack);
  if (!collider.moves()) return;
  const auto& [position, rotation] = pose;
  const auto& [velocity, spin, center] = twist;
  add(h, position), add(h, rotation), add(h, velocity), add(h, spin), add(h, center);
  add(h, surface_pose.position), add(h, surface_pose.rotation);
  if (changing) h.add(surface_time);
}

void add(Hash64& h, const Spring& spring) {
  const auto& [to, stiffness, damping] = spring;
  add(h, to), h.add(stiffness), h.add(damping);
}

void add(Hash64& h, const RigidBody& body) {
  const auto& [collider, mass, center, inertia, restitution, locked, spring, hold] = body;
  h.add(collider), h.add(mass), add(h, center), h.add(restitution);
  for (const double i : inertia.m) h.add(i);
  for (const bool l : locked) h.add(l);
  if (spring) add(h, *spring);
  if (hold) add(h, hold->at), add(h, hold->spring);
}

void add(Hash64& h, const Emitter& emitter) {
  const auto& [name, shape, set, along, speed, swirl, jitter, start, stop, pool, recycle, born, dry, path, color] =
      emitter;
  // The scene's own hash has the shape and the path; the color decides nothing.
  static_cast<void>(shape), static_cast<void>(path), static_cast<void>(color);
  h.add(std::string_view(name)), h.add(set), add(h, along), h.add(swirl), h.add(jitter), h.add(start), h.add(stop);
  for (const Key<double>& k : speed) h.add(k.t), h.add(k.value);
  h.add(pool), h.add(recycle), h.add(born), h.add(dry);
}

void add(Hash64& h, const Sink& sink) {
  const auto& [name, shape, collider, taken, momentum, angular, path] = sink;
  static_cast<void>(shape), static_cast<void>(path), static_cast<void>(momentum), static_cast<void>(angular);
  h.add(std::string_view(name)), h.add(collider.has_value()), h.add(taken);
}

void add(Hash64& h, const std::string& text) { h.add(std::string_view(text)); }

void add(Hash64& h, const Values& values) {
  for (const auto& [key, value] : values) h.add(std::string_view(key)), h.add(value);
}

void add(Hash64& h, const TransferRule<double>& rule) {
  const auto& [affine, blend, advance, memory] = rule;
  if (rule.keeps_velocity() || affine != 1) h.add(affine), h.add(blend), h.add(advance);
  if (memory > 0) h.add(memory);
}

template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void add(Hash64& h, T number) {
  h.add(number);
}

/// Adds a World, member by member.
template <class R>
class WorldHash {
 public:
  explicit WorldHash(const World<R>& world) : world_(world) {
    const World<R> initial;
    visit_fields(world, initial, [&]<class F, class T>(const F&, const T& value, const T& unset) {
      if constexpr (F::use.hashed) {
        if constexpr (F::use.sparse)
          if (value == unset) return;
        take(value);
      }
    });
  }
  std::uint64_t value() const { return h_.value(); }

 private:
  template <class T>
  void take(const T& value) {
    add(h_, value);
  }
  template <class T, std::size_t n>
  void take(const std::array<T, n>& values) {
    for (const T& v : values) take(v);
  }
  template <class T>
  void take(const std::vector<T>& values) {
    for (const T& v : values) take(v);
  }
  void take(const LargeVector<R>& numbers) { h_.bytes(numbers.data(), numbers.size() * sizeof(R)); }
  /// A node: where in space the scene lies does not count.
  void take(const Vec3i& node) { add(h_, node - world_.low); }
  /// Blocks of particles are part of the particles' places.
  void take(const std::vector<Vec3i>&) {}
  void take(const ParticleSet<R>& set) {
    visit_fields(set, [&]<class F>(const F&, const auto& member) {
      if constexpr (F::use.hashed && F::use.copied) take(member);
    });
    std::vector<std::uint32_t> block(set.size());
    for (std::size_t b = 0; b + 1 < set.block_start.size(); ++b)
      std::fill(block.begin() + set.block_start[b], block.begin() + set.block_start[b + 1],
                static_cast<std::uint32_t>(b));
    for (const std::uint32_t p : order_of<std::uint32_t>(set.id))
      visit_fields(set, [&]<class F>(const F&, const auto& member) {
        if constexpr (F::use.hashed && F::use.carried)
          visit_columns(member, [&](const auto& column) {
            if (!column.empty()) h_.add(column[p]);
          });
        else if constexpr (F::use.hashed && !F::use.copied)  // block_start
          take(first_stencil(world_.particle_blocks[block[p]]));
      });
  }
  void take(const GridFields<R>& grid) {
    for (std::size_t b = 0; b < grid.blocks.size(); ++b) take(grid.blocks[b] * block_width);
    visit_nodes(grid, [&](const auto&, const auto& nodes) { h_.bytes(nodes.data(), nodes.size() * sizeof(Node<R>)); });
  }

  const World<R>& world_;
  Hash64 h_;
};

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
  return WorldHash<R>(world).value();
}

template bool World<float>::measures_by_volume(std::size_t) const;
template bool World<double>::measures_by_volume(std::size_t) const;
template std::uint64_t state_hash(const World<float>&);
template std::uint64_t state_hash(const World<double>&);

}  // namespace dreampm
