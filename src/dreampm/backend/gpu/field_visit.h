// Force fields at the nodes of the grid on a device: as BlockVisit::momentum_to_velocity applies
// them, and their work.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <variant>

#include "dreampm/backend/gpu/node_visit.h"
#include "dreampm/physics/fields.h"

namespace dreampm::gpu {

/// One step of a force field of any kind.
class FieldStep {
 public:
  using Any = Fields::Step<float>;

  /// `box`: where it acts.
  FieldStep(const Any& step, const Box3d& box) : box_(box), kind_(static_cast<std::int32_t>(step.index())) {
    std::visit([&](const auto& one) { std::memcpy(bytes_, &one, sizeof one); }, step);
  }
  /// True if it acts anywhere in a box.
  DM_FN bool meets(const Vec3d& low, const Vec3d& high) const {
    for (int a = 0; a < 3; ++a)
      if (low[a] > box_.max[a] || high[a] < box_.min[a]) return false;
    return true;
  }
  /// The velocity [m/s] after it, of a node at scene position `x` [m].
  DM_FN Vec3<float> apply(const Vec3<float>& v, const Vec3d& x) const {
    return meets(x, x) ? of_kind(v, static_cast<Vec3<float>>(x)) : v;
  }

 private:
  template <std::size_t kind = 0>
  DM_FN Vec3<float> of_kind(const Vec3<float>& v, const Vec3<float>& x) const {
    if constexpr (kind == std::variant_size_v<Any>) {
      return v;
    } else {
      if (kind_ != static_cast<std::int32_t>(kind)) return of_kind<kind + 1>(v, x);
      std::variant_alternative_t<kind, Any> step;
      __builtin_memcpy(&step, bytes_, sizeof step);
      return step(v, x);
    }
  }

  template <class T>
  struct Room;
  template <class... S>
  struct Room<std::variant<S...>> {
    static_assert((std::is_trivially_copyable_v<S> && ...), "a field's step is copied to the device as it stands");
    static constexpr std::size_t size = [] {
      std::size_t most = 0;
      ((most = sizeof(S) > most ? sizeof(S) : most), ...);
      return most;
    }();
  };
  Box3d box_;
  std::int32_t kind_;
  alignas(8) unsigned char bytes_[Room<Any>::size];
};

/// The fields of a step, and what they give.
struct FieldInput {
  const FieldStep* fields;
  std::int32_t count;
  Vec3<float>* impulses[2];  ///< kg m/s, by field of the grid and node; of blocks where any acts
  SourceTerms* given;        ///< by block of the grid

  /// True if any acts at a node of that block.
  DM_FN bool any_in(const VisitInput& in, int block) const {
    const Vec3d first = in.places.of(in.blocks[block].first);
    const double width = (block_width - 1) * in.places.dx;
    for (int i = 0; i < count; ++i)
      if (fields[i].meets(first, first + Vec3d{width, width, width})) return true;
    return false;
  }
};

/// Changes the velocities of nodes. A block of threads takes a block of the grid.
struct ApplyFields {
  static constexpr int threads = block_nodes;
  struct Shared {
    ImpulseTerms<float> given[threads];
  };
  VisitInput in;
  FieldInput by;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    if (!by.any_in(in, b)) {
      block.each_thread([&](int t) {
        if (t == 0) by.given[b] = SourceTerms::none();
      });
      return;
    }
    add_up_fields<threads>(in.grid, block, shared.given, [&](int f, int t) { return apply(f, b, t); });
    block.each_thread([&](int t) {
      if (t == 0) by.given[b] = in.places.about_origin(shared.given[0], in.blocks[b].first);
    });
  }

 private:
  DM_FN ImpulseTerms<float> apply(int f, int b, int n) const {
    const std::int64_t at = std::int64_t{b} * block_nodes + n;
    Node<float>& node = in.grid.field[f][at];
    ImpulseSumOf<float> given;
    Vec3<float> impulse{0, 0, 0};
    if (has_mass(node)) {
      const Vec3<float> free = velocity(node);
      const Vec3d place = in.places.of(in.blocks[b].first + node_offset(n));
      Vec3<float> v = free;
      for (int i = 0; i < by.count; ++i) v = by.fields[i].apply(v, place);
      given.add(static_cast<Vec3<float>>(node_offset(n)), node.m, free, v, {0, 0, 0});
      impulse = (v - free) * node.m;
      set_velocity(node, v);
    }
    by.impulses[f][at] = impulse;
    return ImpulseTerms<float>::of(given);
  }
};

/// The work of these impulses at the velocities that the nodes have in the end.
struct FieldWork {
  static constexpr int threads = block_nodes;
  struct Shared {
    ImpulseTerms<float> given[threads];
  };
  VisitInput in;
  FieldInput by;

  template <class Block>
  DM_FN void operator()(Block& block, Shared& shared) const {
    const int b = block.index();
    if (!by.any_in(in, b)) return;  // none is known
    add_up_fields<threads>(in.grid, block, shared.given, [&](int f, int t) {
      const std::int64_t at = std::int64_t{b} * block_nodes + t;
      return ImpulseTerms<float>::of_work(dot(by.impulses[f][at], velocity(in.grid.field[f][at])));
    });
    block.each_thread([&](int t) {
      if (t == 0) by.given[b].work = static_cast<double>(shared.given[0].work);
    });
  }
};

}  // namespace dreampm::gpu
